// SPDX-License-Identifier: MIT
// The Blender add-on and the programs mean the same: its jitter is the host's, its options are quincunx-resolve's.
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "quincunx/frame.h"
#include "sequence/sequence_fixture.h"

namespace quincunx {
namespace {

constexpr Extent kSmall = {32, 18};  // the stand-in's scene at 50 %
constexpr Extent kFull = {64, 36};
constexpr int kFrames = 3, kAhead = 8;

class BlenderAddOn : public testing::SequenceTest {
 protected:
  // Runs lines of Python with the add-on as `addon`, and the stand-in for Blender with a scene in folder_.
  std::string python(const std::string& lines) const {
    std::ofstream(folder_.file("lines.py")) << fmt::format(
        "import sys\nsys.path[:0] = ['{}/fake', '{}']\nimport bpy\nimport quincunx_blender as addon\n"
        "bpy.reset('{}')\nscene = bpy.context.scene\n{}",
        QUINCUNX_TEST_ROOM, QUINCUNX_ADD_ON, folder_.file("."), lines);
    const testing::ProgramResult result = testing::run_program(folder_, "-B '{}/lines.py'", "python3");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  }

  // The words by which the add-on resolves the scene, for a shell.
  std::string command(const std::string& settings = {}) const {
    return python(settings + fmt::format("import shlex\n"
                                         "shot = addon.Shot(scene, bpy.context.view_layer, scene.quincunx)\n"
                                         "print(shlex.join(shot.command('{}')), end='')\n",
                                         QUINCUNX_PROGRAM));
  }

  // Frames as Cycles writes them.
  void write_small_frames() const {
    const std::array<const char*, 9> names = {
        "ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B",
        "ViewLayer.Combined.A", "ViewLayer.Depth.Z",    "ViewLayer.Vector.X",
        "ViewLayer.Vector.Y",   "ViewLayer.Vector.Z",   "ViewLayer.Vector.W"};
    std::filesystem::create_directories(folder_.file("shot_small"));
    const std::vector<float> values(static_cast<std::size_t>(kSmall.area()), .5f);
    std::vector<tools::Channel> channels;
    for (const char* name : names)
      channels.push_back({.name = name,
                          .type = tools::ChannelType::kFloat,
                          .data = values.data(),
                          .stored = tools::ChannelType::kFloat});
    for (int frame = 1; frame <= kFrames + kAhead; ++frame) {
      const Status status =
          tools::write_exr(folder_.file(fmt::format("shot_small/frame.{:04}.exr", frame)), kSmall, channels,
                           std::array<tools::Attribute, 1>{{{"cycles.ViewLayer.samples", "4"}}});
      ASSERT_TRUE(status.ok()) << status.message();
    }
  }

  testing::ProgramResult run_in_shot(const std::string& words) const {
    return testing::run_program(folder_, words,
                                fmt::format("cd '{}' &&", folder_.file("shot_small")).c_str());
  }
};

TEST_F(BlenderAddOn, JitterIsThatOfTheProgram) {
  // Both work in double precision and round at the end: to a float here, whose values lie within 1/2.
  constexpr double kRounding = 0x1p-24;
  constexpr int kShown = 140;  // frames; no size below has more places
  struct Sizes {
    Extent small, full;
  };
  for (const auto& [small, full] :
       {Sizes{{240, 135}, {480, 270}}, Sizes{{228, 128}, {455, 255}}, Sizes{{100, 60}, {300, 180}},
        Sizes{{455, 256}, {640, 360}}, Sizes{{160, 90}, {640, 360}}, Sizes{{7, 5}, {7, 5}}}) {
    std::istringstream values(
        python(fmt::format("for frame in range({}):\n"
                           "    print(*addon.jitter_of(frame, ({}, {}), ({}, {})))\n",
                           kShown, small.width, small.height, full.width, full.height)));
    for (int frame = 0; frame < kShown; ++frame) {
      double x = 0, y = 0;
      ASSERT_TRUE(values >> x >> y);
      const Vec2 expected = jitter(static_cast<std::uint64_t>(frame), small, full);
      EXPECT_NEAR(x, expected.x, kRounding) << frame << " of " << small.width << "x" << small.height;
      EXPECT_NEAR(y, expected.y, kRounding) << frame << " of " << small.width << "x" << small.height;
    }
  }
}

TEST_F(BlenderAddOn, OptionsAreThoseOfTheProgram) {
  write_small_frames();
  const std::string words = command("scene.quincunx.options = '--sharpen 0.3'\n");
  const auto listed = run_in_shot(words + " --dry-run --json");
  ASSERT_EQ(listed.exit_code, 0) << words << "\n" << listed.err;
  const auto listing = nlohmann::json::parse(listed.out);
  EXPECT_EQ(listing["method"], "temporal:balanced");
  EXPECT_EQ(listing["make"], nlohmann::json({1, 2, 3}));
  EXPECT_EQ(listing["history_only"], nlohmann::json({4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_EQ(listing["warnings"], nlohmann::json::array());
  EXPECT_EQ(
      listing["format"],
      "colour ViewLayer.Combined.R,ViewLayer.Combined.G,ViewLayer.Combined.B,ViewLayer.Combined.A; velocity "
      "ViewLayer.Vector.X,ViewLayer.Vector.Y blender; depth ViewLayer.Depth.Z linear, near 0.0009765625; "
      "both ways, 8 frames ahead by ViewLayer.Vector.Z,ViewLayer.Vector.W; jitter halton");
  const auto made = run_in_shot(words + " -q");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  for (int frame = 1; frame <= kFrames; ++frame)
    EXPECT_EQ(image(folder_.file(fmt::format("shot_{:04}.exr", frame))).extent, kFull);
}

// The add-on tries its words before there are frames: a wrong option must then be refused as such.
TEST_F(BlenderAddOn, AWrongOptionIsToldFromMissingFrames) {
  std::filesystem::create_directories(folder_.file("shot_small"));
  const std::string words = command();
  EXPECT_EQ(run_in_shot(words + " --dry-run").exit_code, 1);
  EXPECT_EQ(run_in_shot(words + " --sharpen 7 --dry-run").exit_code, 2);
}

}  // namespace
}  // namespace quincunx
