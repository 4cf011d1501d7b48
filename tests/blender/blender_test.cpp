// SPDX-License-Identifier: MIT
// The add-on in Blender itself, as docs/sequences.md runs it without a display: Cycles renders a shot at half size, and
// what is made of it is nearer to the truth than Blender's own frames of that size.
#include <filesystem>

#include "sequence/sequence_fixture.h"
#include "skip.h"
#include "tools/image/image_metrics.h"

namespace quincunx {
namespace {

constexpr Extent kFull = {320, 180};
constexpr int kFrames = 24, kSamples = 8, kTruthSamples = 64;
constexpr int kLast = kFrames;   // the frame that is compared
constexpr double kGainInDb = 2;  // what is promised

class Blender : public testing::SequenceTest {
 protected:
  void SetUp() override {
    if (std::system("command -v blender >/dev/null") != 0)
      QUINCUNX_SKIP("Blender is not installed (package blender)");
    run(fmt::format("-b --factory-startup --python '{}/make_scene.py' -- '{{}}/shot.blend' {} {} {} {}",
                    QUINCUNX_TEST_ROOM, kFull.width, kFull.height, kFrames, kSamples));
    ASSERT_TRUE(std::filesystem::exists(folder_.file("shot.blend")));
  }

  testing::ProgramResult blender(const std::string& arguments) const {
    return testing::run_program(folder_, arguments, "blender");
  }

  void run(const std::string& arguments) const {
    const testing::ProgramResult result = blender(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }

  // `call`: of the add-on.
  testing::ProgramResult add_on(const std::string& call) const {
    return blender(
        fmt::format("-b '{{}}/shot.blend' --python-expr \"import sys; sys.path.append('{}'); "
                    "import quincunx_blender as addon; {}\"",
                    QUINCUNX_ADD_ON, call));
  }

  // The last frame as Blender alone renders it, at this part of the full size.
  void render(const std::string& name, int samples, int percent) const {
    run(
        fmt::format("-b '{{}}/shot.blend' --python-expr \"import bpy; scene = bpy.context.scene; "
                    "scene.cycles.samples = {}; scene.render.resolution_percentage = {}\" "
                    "-F OPEN_EXR -o '{{}}/{}.####' -f {}",
                    samples, percent, name, kLast));
  }

  tools::MeasuredPicture picture(const std::string& name) const {
    const tools::LoadedImage file = image(folder_.file(fmt::format("{}{:04}.exr", name, kLast)));
    std::vector<float> rgba;
    for (int y = 0; y < file.extent.height; ++y) {
      for (int x = 0; x < file.extent.width; ++x) {
        for (const char* channel : {"R", "G", "B"})
          rgba.push_back(file.at(x, y, file.channel(channel)));
        rgba.push_back(1);
      }
    }
    return {file.extent, rgba};
  }
};

TEST_F(Blender, ResolvedFramesAreNearerToTheTruthThanSmallOnesScaledUp) {
  const auto result = add_on(fmt::format("addon.run(program='{}')", QUINCUNX_PROGRAM));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("32 frames of 160x90 rendered"), std::string::npos) << result.out;
  for (int frame = 1; frame <= kFrames; ++frame)
    EXPECT_EQ(image(folder_.file(fmt::format("out/shot_{:04}.exr", frame))).extent, kFull);

  render("truth", kTruthSamples, 100);
  render("f", kSamples, 50);
  resolve_to("scaled", fmt::format("--frames {} --method catmull-rom --output {}x{}", kLast, kFull.width,
                                   kFull.height));
  const tools::MeasuredPicture truth = picture("truth.");
  const double scaled = tools::psnr_tone_mapped(picture("scaled."), truth);
  const double resolved = tools::psnr_tone_mapped(picture("out/shot_"), truth);
  EXPECT_GE(resolved, scaled + kGainInDb)
      << "scaled up: " << scaled << " dB, resolved: " << resolved << " dB";
}

TEST_F(Blender, EverySettingIsPutBackAndAFailureIsOneSentence) {
  const std::string state =
      "state = lambda: [str(getattr(o, p.identifier)) for o in (s.render, s.render.image_settings, s.cycles, "
      "bpy.context.view_layer) for p in o.bl_rna.properties if p.type in ('INT', 'FLOAT', 'BOOLEAN', "
      "'STRING', "
      "'ENUM') and not getattr(p, 'is_array', False)] + [s.camera.data.name, len(bpy.data.cameras), "
      "s.frame_start, s.frame_end]";
  const std::string prepare =
      "import bpy; s = bpy.context.scene; s.frame_end = 2; s.render.image_settings.file_format = 'JPEG'; " +
      state + "; before = state(); ";
  const auto good = add_on(
      prepare + fmt::format("addon.run(program='{}'); print('same', state() == before)", QUINCUNX_PROGRAM));
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_NE(good.out.find("same True"), std::string::npos) << good.out;

  const std::string at_exit = "import atexit; atexit.register(lambda: print('same', state() == before)); ";
  const auto expect_failure = [&](const std::string& call, const std::string& sentence) {
    const auto bad = add_on(prepare + at_exit + call);
    EXPECT_EQ(bad.exit_code, 1) << bad.err;
    EXPECT_EQ(bad.err, sentence + "\n");
    EXPECT_NE(bad.out.find("same True"), std::string::npos) << bad.out;
  };
  expect_failure("addon.run(program='/nonesuch')",
                 "quincunx: There is no program '/nonesuch'; install Quincunx, or set the add-on's Program.");
  expect_failure(
      fmt::format("import os; bpy.app.handlers.render_pre.append(lambda *_: os.kill(os.getpid(), 2)); "
                  "addon.run(program='{}')",
                  QUINCUNX_PROGRAM),
      "quincunx: The render was cancelled; nothing is resolved.");
}

TEST_F(Blender, APreviewIsOneFrameAndADraftHasHalfTheSize) {
  const auto result = add_on(fmt::format(
      "import bpy; bpy.context.scene.frame_current = {}; addon.run(program='{}', preview=True, draft=True)",
      kLast, QUINCUNX_PROGRAM));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("17 frames of 160x90 rendered"), std::string::npos) << result.out;
  EXPECT_EQ(image(folder_.file(fmt::format("out/draft_preview_shot_{:04}.exr", kLast))).extent,
            (Extent{kFull.width / 2, kFull.height / 2}));
  EXPECT_EQ(image(folder_.file(fmt::format("out/preview_shot_{:04}.exr", kLast))).extent, kFull);
  const auto files = std::distance(std::filesystem::directory_iterator(folder_.file("out")), {});
  EXPECT_EQ(files, 2);
}

TEST_F(Blender, AnAbortLeavesWholeFiles) {
  const auto result = add_on(fmt::format(
      "import bpy\naddon.register()\njob = addon.Job(bpy.context, '{}')\njob.begin()\njob.render()\n"
      "while not job.step() and job.progress()[0] == 0:\n  pass\njob.end()\n",
      QUINCUNX_PROGRAM));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  int results = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.file("out"))) {
    if (entry.is_directory()) continue;  // the small frames
    EXPECT_EQ(image(entry.path().string()).extent, kFull);
    ++results;
  }
  EXPECT_GT(results, 0);
  EXPECT_LT(results, kFrames);
}

// By Blender's own projection: of odd sizes, both fits of the lens, pixels that are not square.
TEST_F(Blender, ShiftsMoveWhatIsSeenByTheJitter) {
  constexpr double kSinglePrecision = 1e-4;  // pixels: some 300 of them, in numbers of 24 bits
  const auto result = blender(fmt::format("-b '{{}}/shot.blend' --python '{}/check_shifts.py' -- '{}'",
                                          QUINCUNX_TEST_ROOM, QUINCUNX_ADD_ON));
  double of_jitter = 1, of_picture = 1;
  const std::size_t at = result.out.find("errors ");
  ASSERT_NE(at, std::string::npos) << result.err;
  ASSERT_EQ(std::sscanf(result.out.c_str() + at, "errors %lf %lf", &of_jitter, &of_picture), 2);
  EXPECT_LT(of_jitter, kSinglePrecision);
  EXPECT_LT(of_picture, kSinglePrecision);
}

}  // namespace
}  // namespace quincunx
