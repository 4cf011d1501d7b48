// SPDX-License-Identifier: MIT
// Conventions of other programs: the doctor names each, and what it says to mend it does.
#include <functional>

#include "diagnose_stage.h"
#include "parsed_options.h"
#include "tools/sequence/resolve_task.h"

namespace quincunx {
namespace {

using testing::DiagnosedFrame;
using testing::Frames;
using testing::Stage;
using tools::Matrix;

using Change = std::function<void(DiagnosedFrame&)>;

Change motion(const std::function<Vec2(Vec2)>& change) {
  return [change](DiagnosedFrame& frame) {
    for (Vec2& v : frame.velocity)
      v = change(v);
  };
}

Change depth(const std::function<float(float)>& change) {
  return [change](DiagnosedFrame& frame) {
    for (float& z : frame.depth)
      z = change(z);
  };
}

// What frames and the doctor's input are under options of the command line, as a run takes them.
void apply(const std::string& words, Frames& frames, tools::DiagnosedInput& input) {
  const tools::ResolveOptions options = testing::parsed_options(words);
  const tools::SequenceInput& said = options.sequence;
  input.units = said.units.value_or(input.units);
  input.velocity_offset = said.velocity_offset;
  input.depth_kind = said.depth_kind.value_or(input.depth_kind);
  input.depth_range = said.depth_range;
  input.camera = said.camera.value_or(input.camera);
  for (DiagnosedFrame& frame : frames) {
    for (Vec2& v : frame.velocity)
      v = tools::difference(v, said.velocity_offset);
    tools::scale_depth(said.depth_range, input.depth_kind, frame.depth);
  }
}

// The doctor names a change of frames; with the options that it says in place of `words`, nothing is wrong.
void expect_mended(Frames frames, const Change& change, const std::string& subject, const std::string& fits,
                   const std::string& mend, const std::string& words = "") {
  for (DiagnosedFrame& frame : frames)
    change(frame);
  Frames wrong = frames;
  tools::DiagnosedInput input = testing::kInput, mended_input = input;
  apply(words, wrong, input);
  const tools::Diagnosis diagnosis = tools::diagnose(wrong, input);
  const tools::Finding& found = testing::finding(diagnosis, subject);
  EXPECT_NE(found.fits.find(fits), std::string::npos) << fits << ": " << found.fits << "\n"
                                                      << testing::named(diagnosis);
  EXPECT_EQ(found.option.substr(0, mend.size()), mend) << found.fits;
  apply(found.option, frames, mended_input);
  const tools::Diagnosis mended = tools::diagnose(frames, mended_input);
  EXPECT_EQ(testing::named(mended), "none") << found.option;
  EXPECT_EQ(testing::finding(mended, "velocity").verdict, tools::Verdict::kRight) << found.option;
}

Change times(float factor) {
  return motion([factor](Vec2 v) { return Vec2{v.x * factor, v.y * factor}; });
}

TEST(Mends, MotionOfHalfAFrameOrOfTwo) {
  const Frames whole = Stage({.frames = 6}).frames();
  expect_mended(whole, times(.5f), "velocity", "half as long as a frame's",
                "--velocity-scale -0.0125,0.0222222");
  expect_mended(whole, times(2), "velocity", "twice as long as a frame's",
                "--velocity-scale -0.003125,0.00555556");
}

TEST(Mends, MotionOfAnyLength) {
  const Frames whole = Stage({.frames = 6}).frames();
  expect_mended(whole, times(-1 / 3.f), "velocity", "3 times as long, the other direction",
                "--velocity-scale 0.01875");
  expect_mended(whole, times(24), "velocity", "times as long", "--velocity-scale -0.00025");
}

// Motion of so many pixels from 0 to 1, in so many steps if any.
Change about_the_middle(float reach, float steps) {
  return motion([=](Vec2 v) {
    const auto code = [=](float c) {
      const float value = .5f + c / reach;
      return steps > 0 ? std::round(value * steps) / steps : value;
    };
    return Vec2{code(v.x), code(v.y)};
  });
}

TEST(Mends, MotionAboutTheMiddle) {
  const Frames whole = Stage({.frames = 6}).frames();
  const std::string middle = "about the middle of 0 to 1";
  expect_mended(whole, about_the_middle(32, 0), "velocity", middle,
                "--velocity-offset 0.5 --velocity-scale -0.", "--velocity-scale 0.333,0.5");
  expect_mended(whole, about_the_middle(24, 255), "velocity", middle, "--velocity-offset 0.5");
}

TEST(Mends, PartsOfThePictureAboutTheMiddle) {
  const auto uv = motion([](Vec2 v) { return Vec2{.5f - v.x / 160, .5f + v.y / 90}; });
  expect_mended(Stage({.frames = 6}).frames(), uv, "velocity", "about the middle of 0 to 1",
                "--velocity-offset 0.5 --velocity-scale ");
}

TEST(Mends, DepthThatIsNoDistance) {
  Frames whole = Stage({.frames = 6}).frames();
  const auto blind = [](const Change& change) {
    return [change](DiagnosedFrame& frame) {
      change(frame);
      frame.world_to_ndc = Matrix{};
    };
  };
  const auto negative = depth([](float z) { return -z; });
  expect_mended(whole, negative, "depth", "negative", "--depth-range 0,-1");
  expect_mended(whole, blind(negative), "depth", "negative", "--depth-range 0,-1");
  const auto inverse = depth([](float z) { return -testing::kNear / z; });
  expect_mended(whole, inverse, "depth", "negative, device-reversed",
                "--depth-range 0,-1 --depth-kind device-reversed");
  expect_mended(whole, blind(inverse), "depth", "negative, device-reversed",
                "--depth-range 0,-1 --depth-kind device-reversed");
  const auto white = depth([](float z) { return 1 - (z - 1) / 30; });
  expect_mended(whole, blind(white), "depth", "device-reversed", "--depth-kind device-reversed");
  expect_mended(whole, depth([](float z) { return z * 1000; }), "depth", "to 0.001 at 1",
                "--depth-range 0,0.001");
}

// Surfaces that are not seen head-on show where the camera is on depth's scale.
TEST(Mends, DepthBetweenTwoPlanes) {
  const Frames whole = Stage({.frames = 6}).frames();
  for (const bool white_is_near : {true, false}) {
    Frames frames = whole;
    for (DiagnosedFrame& frame : frames) {
      for (std::size_t i = 0; i < frame.depth.size(); ++i) {
        const float down = (static_cast<float>(i / testing::kRender.width) + .5f) / 45 - 1;
        const float z = 6 / (1.1f + down);  // a floor
        frame.depth[i] = white_is_near ? 1 - (z - 1) / 70 : (z - 1) / 70;
      }
      frame.world_to_ndc = Matrix{};
    }
    const tools::Diagnosis diagnosis = tools::diagnose(frames, testing::kInput);
    const std::string said = testing::finding(diagnosis, "depth").option;
    Vec2 range;
    ASSERT_EQ(std::sscanf(said.c_str(), "--depth-range %f,%f", &range.x, &range.y), 2) << said;
    // In whatever unit: 71 and 1, or 1 and 71.
    EXPECT_NEAR(range.x / range.y, white_is_near ? 71 : 1 / 71., white_is_near ? 3 : .002) << said;
  }
}

TEST(Mends, CamerasOfAnotherSense) {
  const Frames whole = Stage({.frames = 6}).frames();
  const auto flipped = [](DiagnosedFrame& frame) {
    for (std::size_t row = 0; row < 16; row += 4)
      (*frame.world_to_ndc)[row + 1] *= -1;
  };
  expect_mended(whole, flipped, "camera", "screen,flipped", "--world-to-ndc screen,flipped");
  expect_mended(
      whole, [](DiagnosedFrame&) {}, "camera", "screen", "--world-to-ndc screen", "--world-to-ndc openexr ");
  // What a run finds by itself needs no mend.
  Frames frames = whole;
  for (DiagnosedFrame& frame : frames)
    for (std::size_t row = 0; row < 16; row += 4) {
      Matrix& m = *frame.world_to_ndc;
      m[row] = (m[row] + m[row + 3]) / 2, m[row + 1] = (m[row + 3] - m[row + 1]) / 2;
    }
  EXPECT_EQ(tools::sense_of(*frames[0].world_to_ndc, testing::kRender), (tools::CameraSense{.unit = true}));
}

}  // namespace
}  // namespace quincunx
