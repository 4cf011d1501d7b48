// SPDX-License-Identifier: MIT
// quincunx-dump: its numbers are those of quincunx-render, its files whole, its refusals clear.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "program_run.h"
#include "tools/image/image_io.h"

namespace quincunx {
namespace {

using testing::ProgramResult;
using testing::read_file;
using testing::run_program;

class Dump : public ::testing::Test {
 protected:
  ProgramResult dump(const std::string& arguments) { return run_program(folder_, arguments, QUINCUNX_DUMP); }

  void expect_done(const ProgramResult& result) { ASSERT_EQ(result.exit_code, 0) << result.err; }

  void expect_refused(const std::string& arguments, const std::string& part) {
    const ProgramResult result = dump(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments << "\n" << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << arguments << "\n" << result.err;
    EXPECT_EQ(folder_.entries(), 2) << arguments;
  }

  tools::LoadedImage image(const std::string& name) const {
    auto loaded = tools::read_image(folder_.file(name));
    EXPECT_TRUE(loaded.ok()) << loaded.status().message();
    return loaded.value();
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Dump, ItsStagesAreThoseOfTheRenderer) {
  const std::string run = "-q --scene particles --output 160x90 --scale 0.71,0.6 --seed 3 ";
  expect_done(run_program(folder_, run + "--frames 6 --exr-frame 5 --out '{}/f.%04d.png'"));
  expect_done(dump(run + "--frame 5 --out '{}/d'"));

  const auto drawn = image("frame_0005_targets.exr");
  const auto render = image("d/frame.0005.render.exr");
  EXPECT_EQ(render.channels, drawn.channels);
  EXPECT_EQ(render.pixels, drawn.pixels);
  EXPECT_EQ(image("d/frame.0005.presented.png").pixels, image("f.0005.png").pixels);

  const auto resolved = image("frame_0005_resolved.exr");
  const auto output = image("d/frame.0005.output.exr");
  ASSERT_EQ(output.extent, resolved.extent);
  for (const char* name : {"R", "G", "B", "A"}) {
    const int here = output.channel(name);
    const int there = resolved.channel(name);
    ASSERT_GE(here, 0);
    for (int y = 0; y < output.extent.height; ++y) {
      for (int x = 0; x < output.extent.width; ++x) {
        // The renderer stores halves, the dump floats.
        ASSERT_NEAR(output.at(x, y, here), resolved.at(x, y, there),
                    0x1p-11 * output.at(x, y, here) + 0x1p-25);
      }
    }
  }
}

TEST_F(Dump, EveryStageHasAPictureAndTheFilesAreNamed) {
  const ProgramResult result =
      dump("--scene wheel --output 96x54 --scale 0.5 --frame 3 --truth 2 --out '{}/d'");
  expect_done(result);
  for (const char* stage : {"colour", "depth", "velocity", "reactive", "clear", "history", "resolved",
                            "presented", "truth", "error", "flip"}) {
    const std::string file = "d/frame.0003." + std::string(stage) + ".png";
    EXPECT_TRUE(std::filesystem::exists(folder_.file(file))) << file;
    EXPECT_NE(result.out.find(file), std::string::npos) << file;
  }
  const auto target = image("d/frame.0003.target.exr");
  double cleared = 0;
  for (const float value : target.pixels)
    cleared += value;
  const Extent viewport = image("d/frame.0003.render.exr").extent;
  EXPECT_LT(viewport.area(), target.extent.area());
  EXPECT_EQ(cleared, viewport.area());
  EXPECT_EQ(target.extent, (Extent{96, 54}));
  EXPECT_GE(image("d/frame.0003.output.exr").channel("truth.G"), 0);
}

TEST_F(Dump, ParticlesOfTheirOwnHaveAViewportOfTheirOwn) {
  expect_done(
      dump("-q --scene particles --output 96x54 --scale 0.5 --particle-scale 0.5 --frame 1 --out '{}/d'"));
  const auto particles = image("d/frame.0001.particles.exr");
  const Extent frame = image("d/frame.0001.render.exr").extent;
  EXPECT_EQ(particles.extent, (Extent{(frame.width + 1) / 2, (frame.height + 1) / 2}));
  const int alpha = particles.channel("A");
  ASSERT_GE(alpha, 0);
  int covered = 0;
  for (int y = 0; y < particles.extent.height; ++y) {
    for (int x = 0; x < particles.extent.width; ++x)
      covered += particles.at(x, y, alpha) > 0.01f ? 1 : 0;
  }
  EXPECT_GT(covered, particles.extent.area() / 50);
  EXPECT_LT(covered, particles.extent.area()) << "the rest is transparent";
  EXPECT_TRUE(std::filesystem::exists(folder_.file("d/frame.0001.particles.png")));
}

TEST_F(Dump, AFocusIsAStageAndChangesNothingElse) {
  const std::string run = "-q --scene wheel --output 96x54 --scale 0.5 --method temporal --frame 3 --out ";
  expect_done(dump(run + "'{}/plain'"));
  expect_done(dump(run + "'{}/focused' --focus 30,10,40,30 --focus-scale 1.5"));
  EXPECT_EQ(image("focused/frame.0003.focus.exr").extent, (Extent{84, 68}));
  for (const char* part : {"render", "history"}) {
    const std::string file = "/frame.0003." + std::string(part) + ".exr";
    EXPECT_EQ(image("focused" + file).pixels, image("plain" + file).pixels) << part;
  }
  EXPECT_NE(image("focused/frame.0003.output.exr").pixels, image("plain/frame.0003.output.exr").pixels);
  const ProgramResult none = dump(run + "'{}/none' --stages focus");
  EXPECT_NE(none.exit_code, 0);
  EXPECT_NE(none.err.find("there is no stage 'focus': no part is in focus; give --focus"), std::string::npos)
      << none.err;
}

// Frames 0 to 5 shade both halves in turn: nothing of the frames before is left in the other one.
TEST_F(Dump, OfACheckerboardTheShadedHalfIsShown) {
  for (const std::string colour : {"rgba16f", "rgba8"}) {
    expect_done(dump("-q --scene pan --output 96x54 --frame 5 --warm-up 5 --shading checkerboard --colour " +
                     colour + " --stages colour --out '{}/" + colour + "'"));
    const auto render = image(colour + "/frame.0005.render.exr");
    const int red = render.channel("R");
    ASSERT_GE(red, 0);
    for (int y = 0; y < render.extent.height; ++y) {
      for (int x = 0; x < render.extent.width; ++x)
        ASSERT_EQ(render.at(x, y, red) != 0, (x + y) % 2 == 1) << colour << " " << x << " " << y;
    }
  }
}

TEST_F(Dump, PlacedTargetsHaveNothingOutsideTheViewport) {
  const std::string run =
      "-q --scene wheel --output 96x54 --scale 0.5,0.6 --method temporal --frame 3 --out ";
  expect_done(dump(run + "'{}/viewport'"));
  expect_done(dump(run + "'{}/placed' --targets placed"));
  for (const char* part : {"render", "history", "output"}) {
    const std::string file = "/frame.0003." + std::string(part) + ".exr";
    EXPECT_EQ(image("placed" + file).pixels, image("viewport" + file).pixels) << part;
  }
  const auto target = image("placed/frame.0003.target.exr");
  EXPECT_EQ(target.extent, image("placed/frame.0003.render.exr").extent);
  EXPECT_EQ(std::count(target.pixels.begin(), target.pixels.end(), 1.0f), target.extent.area());
}

TEST_F(Dump, ADynamicOutputIsShownAsItIsMadeAndAsItIsSeen) {
  expect_refused("--scene wheel --frame 1 --stages displayed --out '{}/e'", "give --dual");
  const std::string run =
      "-q --scene wheel --output 96x54 --scale 0.5 --method temporal --frame 3 --out '{}/d' ";
  expect_done(dump(run + "--dual 0.75 --truth 2"));
  EXPECT_EQ(image("d/frame.0003.output.exr").extent, (Extent{72, 41}));
  EXPECT_EQ(image("d/frame.0003.history.exr").extent, (Extent{72, 41}));
  const auto displayed = image("d/frame.0003.displayed.exr");
  EXPECT_EQ(displayed.extent, (Extent{96, 54}));
  EXPECT_GE(displayed.channel("truth.G"), 0);
  EXPECT_EQ(image("d/frame.0003.displayed.png").extent, (Extent{96, 54}));
}

// In a still scene the picture of frame n is the history that frame n + 1 reads, but for its smoothing of what is
// hardly known and the rounding of history to halves.
TEST_F(Dump, TheHistoryOfTemporalIsWhatWasAccumulated) {
  const std::string run =  // history is exposed light: by 1
      "-q --scene still --output 64x36 --scale 0.5 --method temporal --exposure 1 --format exr ";
  expect_done(dump(run + "--frame 15 --warm-up 15 --stages resolved --out '{}/d'"));
  expect_done(dump(run + "--frame 16 --warm-up 16 --stages history --out '{}/d'"));
  const auto history = image("d/frame.0016.history.exr");
  const auto resolved = image("d/frame.0015.output.exr");
  EXPECT_EQ(history.channels, (std::vector<std::string>{"R", "G", "B", "confidence"}));
  ASSERT_EQ(history.extent, (Extent{64, 36}));
  int known = 0;
  for (int y = 0; y < 36; ++y) {
    for (int x = 0; x < 64; ++x) {
      const float confidence = history.at(x, y, history.channel("confidence"));
      ASSERT_GE(confidence, 0);
      ASSERT_LE(confidence, 32);
      if (confidence < 1.5f) continue;
      ++known;
      for (const char* name : {"R", "G", "B"}) {
        const float seen = resolved.at(x, y, resolved.channel(name));
        ASSERT_NEAR(history.at(x, y, history.channel(name)), seen, 0x1p-10f * seen + 0x1p-24f)
            << name << " at " << x << ", " << y;
      }
    }
  }
  EXPECT_GT(known, 64 * 36 / 2);
}

TEST_F(Dump, AFrameAfterACutReadsNoHistory) {
  // The second shot of the scene begins after four seconds.
  const std::string run = "-q --scene cut --output 32x18 --fps 4 --warm-up 2 --stages history --format exr ";
  for (const std::string method : {"temporal", "quincunx"}) {
    expect_done(dump(run + "--method " + method + " --frame 16 --out '{}/" + method + "'"));
    expect_done(dump(run + "--method " + method + " --frame 17 --out '{}/" + method + "'"));
    for (const float value : image(method + "/frame.0016.history.exr").pixels)
      ASSERT_EQ(value, 0) << method;
    const auto later = image(method + "/frame.0017.history.exr").pixels;
    EXPECT_GT(*std::max_element(later.begin(), later.end()), 0) << method;
  }
}

TEST_F(Dump, FormatsAndStagesAreTheOnesAskedFor) {
  expect_done(dump("-q --scene chart --output 64x36 --stages resolved,depth --format png --out '{}/d'"));
  int files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_.file("d")))
    ++files;
  EXPECT_EQ(files, 2);
}

TEST_F(Dump, ASequenceHoldsEveryFrameItsTruthAndWhatIsConstant) {
  expect_done(
      dump("-q --scene pan --output 64x36 --scale 0.5 --frames 3 --truth 2 --sequence '{}/s/f.%04d.exr'"));
  for (int index = 0; index < 3; ++index) {
    const auto frame = image("s/f.000" + std::to_string(index) + ".exr");
    EXPECT_EQ(frame.extent, (Extent{32, 18}));
    for (const char* name : {"R", "A", "Z", "backward.u", "backward.v", "reactive.mask"})
      EXPECT_GE(frame.channel(name), 0) << name;
    EXPECT_EQ(image("s/truth.000" + std::to_string(index) + ".exr").extent, (Extent{64, 36}));
  }
  const auto json = nlohmann::json::parse(read_file(folder_.file("s/sequence.json")));
  EXPECT_EQ(json["frames"], 3);
  EXPECT_EQ(json["output_size"], nlohmann::json({64, 36}));
  EXPECT_EQ(json["jitter_kind"], "halton");
}

TEST_F(Dump, DeviceDepthIsWrittenAsItWasDrawn) {
  const std::string run = "-q --scene wheel --output 32x18 --frames 1 ";
  expect_done(dump(run + "--sequence '{}/a/f.%04d.exr'"));
  expect_done(dump(run + "--device-depth --sequence '{}/b/f.%04d.exr'"));
  const auto linear = image("a/f.0000.exr");
  const auto device = image("b/f.0000.exr");
  const auto* near_plane = linear.attribute("quincunx:near");
  ASSERT_NE(near_plane, nullptr);
  const float near_distance = std::get<float>(near_plane->value);
  for (int x = 0; x < 32; ++x) {
    const float z = linear.at(x, 9, linear.channel("Z"));
    const float depth = device.at(x, 9, device.channel("Z"));
    EXPECT_NEAR(depth * z, near_distance, 0x1p-22 * near_distance) << x;
  }
}

TEST_F(Dump, ADilatedVelocityIsThatOfTheNearestOfNine) {
  const std::string run = "-q --scene wheel --output 64x36 --frames 1 --start 1 --device-depth ";
  expect_done(dump(run + "--sequence '{}/a/f.%04d.exr'"));
  expect_done(dump(run + "--dilate-velocity --sequence '{}/b/f.%04d.exr'"));
  const auto own = image("a/f.0000.exr");
  const auto dilated = image("b/f.0000.exr");
  int changed = 0;
  for (int y = 0; y < 36; ++y) {
    for (int x = 0; x < 64; ++x) {
      int near_x = x, near_y = y;
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, 35); ++j) {
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, 63); ++i) {
          if (own.at(i, j, own.channel("Z")) <= own.at(near_x, near_y, own.channel("Z"))) continue;
          near_x = i;
          near_y = j;
        }
      }
      for (const char* name : {"backward.u", "backward.v"})
        ASSERT_EQ(dilated.at(x, y, dilated.channel(name)), own.at(near_x, near_y, own.channel(name)));
      changed += dilated.at(x, y, dilated.channel("backward.u")) != own.at(x, y, own.channel("backward.u"));
    }
  }
  EXPECT_GT(changed, 100);
  const auto json = nlohmann::json::parse(read_file(folder_.file("b/sequence.json")));
  EXPECT_EQ(json["drawn_velocity"], "dilated");
}

TEST_F(Dump, MistakesAreAnswered) {
  expect_refused("--scene chart", "--out");
  expect_refused("--scene chart --stages colour,colours --out '{}/d'",
                 "'colours' is none of blurred, clear, colour");
  expect_refused("--scene chart --format jpg --out '{}/d'", "'jpg' is none of both, exr, png");
  expect_refused("-q --scene chart --method bilinear --frame 2 --stages history --out '{}/d'",
                 "there is no stage 'history': the method 'bilinear' uses one frame only");
  expect_refused("-q --scene chart --stages history --out '{}/d'", "no frame comes before");
  expect_refused("-q --scene particles --stages particles --out '{}/d'", "give --particle-scale");
  expect_refused("-q --scene chart --particle-scale 0.5 --stages particles --out '{}/d'",
                 "the scene has none");
  expect_refused("-q --scene particles --particle-scale 0.5 --frames 2 --sequence '{}/f.%04d.exr'",
                 "--sequence excludes it");
  expect_refused("-q --scene chart --frames 2 --sequence '{}/f.%04d.png'", "must end in .exr");
  expect_refused("-q --scene chart --frames 2 --sequence '{}/f.exr'", "f.exr");
  expect_refused("-q --scene nowhere --out '{}/d'", "there is no scene 'nowhere'");
}

}  // namespace
}  // namespace quincunx
