// SPDX-License-Identifier: MIT
// Runs in which nothing stays the same: another resolution, jitter and picture every frame.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "service_fixture.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Pixel;
using testing::random_frame;
using testing::ServiceRig;

struct LongRun {
  const char* name;
  ResolveSettings settings;
  int frames;
};

class RandomResolution : public ::testing::TestWithParam<LongRun> {};

constexpr Extent kOutput{48, 27};
constexpr Extent kTarget{96, 54};

HostFrame poison(float value) {
  HostFrame frame;
  frame.render = kTarget;
  frame.colour = [=](int, int) { return Pixel{value, value, value, value}; };
  frame.velocity = [=](int, int) { return Vec2{value, value}; };
  frame.depth = [=](int, int) { return value; };
  frame.reactive = [=](int, int) { return std::uint8_t{255}; };
  return frame;
}

// Returns the frame as a checkerboard: the pixels that are not shaded hold `value`.
HostFrame with_holes(const HostFrame& frame, float value) {
  HostFrame holed = frame;
  const auto is_hole = [parity = frame.parity](int x, int y) { return (x + y) % 2 != parity; };
  holed.colour = [=](int x, int y) {
    return is_hole(x, y) ? Pixel{value, value, value, value} : frame.colour(x, y);
  };
  holed.velocity = [=](int x, int y) { return is_hole(x, y) ? Vec2{value, value} : frame.velocity(x, y); };
  holed.depth = [=](int x, int y) { return is_hole(x, y) ? value : frame.depth(x, y); };
  holed.reactive = [=](int x, int y) { return is_hole(x, y) ? std::uint8_t{255} : frame.reactive(x, y); };
  return holed;
}

// Any size up to the largest, but for two frames in a row often the same.
Extent random_output(std::mt19937& random, int frame) {
  const auto below = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  static Extent kept = kOutput;
  if (frame == 0 || below(3) == 0) kept = {1 + below(kOutput.width), 1 + below(kOutput.height)};
  return kept;
}

// Values outside the viewport, or in pixels that are not shaded, change no bit of any frame, and no frame has a value
// that is not finite.
TEST_P(RandomResolution, PoisonOutsideNeverShows) {
  const LongRun& run = GetParam();
  ServiceRig clean({}, run.settings, kOutput, kTarget);
  ServiceRig poisoned({}, run.settings, kOutput, kTarget);
  std::mt19937 random(2012);
  const float values[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity(), 1e30f};
  for (int i = 0; i < run.frames; ++i) {
    HostFrame frame = random_frame(random, kTarget);
    if (run.settings.output.min_extent != Extent{}) frame.output = random_output(random, i);
    const bool checkerboard = run.settings.targets.shading == Shading::kCheckerboard;
    if (checkerboard && frame.render != Extent{1, 1}) frame.parity = i % 2;
    poisoned.flood(poison(values[i % 4]));
    const std::vector<Pixel> expected = clean.resolve(frame);
    const std::vector<Pixel> actual =
        poisoned.resolve(checkerboard ? with_holes(frame, values[i % 4]) : frame);
    ASSERT_EQ(std::memcmp(expected.data(), actual.data(), expected.size() * sizeof(Pixel)), 0)
        << "frame " << i << ", " << frame.render.width << "x" << frame.render.height;
    ASSERT_EQ(clean.presented(), poisoned.presented()) << "frame " << i;
    for (const Pixel& pixel : actual) {
      for (const float value : pixel)
        ASSERT_TRUE(std::isfinite(value)) << "frame " << i;
    }
  }
}

const LongRun kRuns[] = {
    {"velocity", {.method = Method::kQuincunx}, 1000},
    {"reprojected",
     {.method = Method::kQuincunx,
      .quincunx = {.form = TwoFrameForm::kReprojected, .residual_weight = 1},
      .blur = {.shutter = 0.5f}},
     1000},
    {"temporal", {.method = Method::kTemporal}, 1000},
    {"temporal_half", {.method = Method::kTemporal, .temporal = {.history = PixelFormat::kRGBA16F}}, 200},
    {"temporal_rgba8", {.method = Method::kTemporal, .colour = PixelFormat::kRGBA8}, 200},
    {"velocity_rgba8", {.method = Method::kQuincunx, .colour = PixelFormat::kRGBA8}, 200},
    {"catmull_rom", {.method = Method::kCatmullRom}, 200},
    {"bilinear", {.method = Method::kBilinear}, 200},
    {"checkerboard_bilinear",
     {.method = Method::kBilinear, .targets = {.shading = Shading::kCheckerboard}},
     400},
    {"checkerboard_quincunx",
     {.method = Method::kQuincunx,
      .targets = {.shading = Shading::kCheckerboard},
      .quincunx = {.form = TwoFrameForm::kReprojected},
      .blur = {.shutter = 0.5f}},
     400},
    {"checkerboard_temporal",
     {.method = Method::kTemporal, .targets = {.shading = Shading::kCheckerboard}},
     400},
    {"checkerboard_rgba8",
     {.method = Method::kTemporal,
      .colour = PixelFormat::kRGBA8,
      .targets = {.shading = Shading::kCheckerboard}},
     200},
    {"noise_offset", {.method = Method::kNoiseOffset}, 200},
    {"dual_bilinear", {.method = Method::kBilinear, .output = {.min_extent = {1, 1}}}, 400},
    {"dual_lanczos3", {.method = Method::kLanczos3, .output = {.min_extent = {1, 1}}}, 400},
    {"dual_reprojected",
     {.method = Method::kQuincunx,
      .sharpness = .5f,
      .output = {.min_extent = {1, 1}},
      .quincunx = {.form = TwoFrameForm::kReprojected, .residual_weight = 1},
      .blur = {.shutter = 0.5f}},
     400},
    {"dual_temporal", {.method = Method::kTemporal, .output = {.min_extent = {1, 1}}}, 1000},
    {"dual_temporal_half",
     {.method = Method::kTemporal,
      .output = {.min_extent = {1, 1}},
      .temporal = {.history = PixelFormat::kRGBA16F}},
     200},
    {"dual_checkerboard",
     {.method = Method::kTemporal,
      .targets = {.shading = Shading::kCheckerboard},
      .output = {.min_extent = {1, 1}}},
     400},
};

INSTANTIATE_TEST_SUITE_P(Methods, RandomResolution, ::testing::ValuesIn(kRuns),
                         [](const auto& instance) { return instance.param.name; });

// A bright thing without velocity flies over a still background and writes reactive values: the frame after
// it has passed shows none of it, whichever form mixes the frames.
TEST(ReactiveValues, TransparentsLeaveNoTrail) {
  for (const TwoFrameForm form : {TwoFrameForm::kMean, TwoFrameForm::kVelocity, TwoFrameForm::kReprojected}) {
    ServiceRig rig({}, {.method = Method::kQuincunx, .quincunx = {.form = form}}, kOutput, {34, 20});
    const auto scene = [](int left, float jitter) {
      const auto inside = [left](int x) { return x >= left && x < left + 6; };
      HostFrame frame;
      frame.render = {34, 20};
      frame.jitter = {jitter, jitter};
      frame.colour = [=](int x, int) { return inside(x) ? Pixel{1, 1, 1, 1} : Pixel{.25f, .25f, .25f, 1}; };
      frame.reactive = [=](int x, int) { return static_cast<std::uint8_t>(inside(x) ? 255 : 0); };
      return frame;
    };
    rig.resolve(scene(4, -.25f));
    const std::vector<Pixel> pixels = rig.resolve(scene(20, .25f));
    for (int x = 0; x < kOutput.width; ++x) {
      const double at = (x + .5) * 34 / kOutput.width;  // render pixels
      const float red = pixels[static_cast<std::size_t>(13 * kOutput.width + x)][0];
      // At the thing's old and new edges, soft by a sample, it may be seen.
      if (at < 3 || (at > 5 && at < 9) || (at > 11 && at < 19) || at > 27) {
        EXPECT_NEAR(red, .25f, 1e-6) << name_of(form) << ", column " << x;
      }
    }
  }
}

}  // namespace
}  // namespace quincunx
