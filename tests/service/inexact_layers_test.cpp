// SPDX-License-Identifier: MIT
// Two layers of history where depth and motion are not exact: rounded, noisy or spread by the renderer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <tuple>
#include <utility>

#include "temporal_scene.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::TemporalRun;

// What a renderer makes of exact inputs.
struct Fault {
  std::string name;
  std::function<void(HostFrame&)> apply;
};

// In [-1, 1], of a sample and a frame.
float noise(int x, int y, float salt) {
  const float value =
      std::sin(12.9898f * static_cast<float>(x) + 78.233f * static_cast<float>(y) + salt) * 43758.5f;
  return 2 * (value - std::floor(value)) - 1;
}

// Velocity in 8 bits over +-16 samples.
void round_velocity(HostFrame& frame) {
  const float columns = 8 * static_cast<float>(frame.render.width);
  const float rows = 8 * static_cast<float>(frame.render.height);
  frame.velocity = [exact = frame.velocity, columns, rows](int x, int y) {
    const Vec2 v = exact(x, y);
    return Vec2{std::round(v.x * columns) / columns, std::round(v.y * rows) / rows};
  };
}

// Velocity of the nearest of 3x3 samples, as many temporal filters want it.
void spread_velocity(HostFrame& frame) {
  frame.velocity = [exact = frame.velocity, depth = frame.depth, render = frame.render](int x, int y) {
    int from_x = x, from_y = y;
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, render.height - 1); ++j) {
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, render.width - 1); ++i) {
        if (depth(i, j) > depth(from_x, from_y)) std::tie(from_x, from_y) = std::pair(i, j);
      }
    }
    return exact(from_x, from_y);
  };
}

// By up to a tenth of a sample each way.
void shake_velocity(HostFrame& frame) {
  const float columns = 10 * static_cast<float>(frame.render.width);
  const float rows = 10 * static_cast<float>(frame.render.height);
  frame.velocity = [exact = frame.velocity, salt = frame.jitter.x, columns, rows](int x, int y) {
    const Vec2 v = exact(x, y);
    return Vec2{v.x + noise(x, y, salt) / columns, v.y + noise(y, x, salt) / rows};
  };
}

void shake_depth(HostFrame& frame) {
  frame.depth = [exact = frame.depth, salt = frame.jitter.x](int x, int y) {
    return exact(x, y) * (1 + .01f * noise(x, y, salt));
  };
}

// The mean over frames 16 to 31.
double error_of(TemporalPreset preset, const std::function<void(HostFrame&)>& apply,
                DrawnVelocity drawn = DrawnVelocity::kOwn) {
  constexpr Extent kRender{80, 48};
  ResolveSettings settings{.method = Method::kTemporal};
  settings.temporal.preset = preset;
  settings.drawn_velocity = drawn;
  TemporalRun run(testing::wires_before_a_wall(), settings);
  double sum = 0;
  for (int i = 0; i < 32; ++i) {
    const int phases = testing::halton_phases(run.scene().output, kRender);
    HostFrame frame = run.scene().render(i, kRender, testing::halton_jitter(i, phases));
    apply(frame);
    const auto shown = run.rig().resolve(frame);
    run.skip();
    if (i >= 16) sum += testing::squared_error(shown, run.truth(), run.scene().output);
  }
  return sum / 16;
}

class InexactLayers : public ::testing::TestWithParam<Fault> {};

// Two layers need surfaces that move apart. Where the renderer has blurred that, little is gained, but nothing lost.
TEST_P(InexactLayers, AreNoWorseThanOne) {
  EXPECT_LE(error_of(TemporalPreset::kBalanced, GetParam().apply),
            error_of(TemporalPreset::kFast, GetParam().apply));
}

INSTANTIATE_TEST_SUITE_P(Faults, InexactLayers,
                         ::testing::Values(Fault{"spread_velocity", spread_velocity},
                                           Fault{"velocity_noise", shake_velocity}),
                         [](const auto& instance) { return instance.param.name; });

// Rounding to an eighth of a sample makes the wires' velocity wrong by .08 output pixels in each frame, always the same
// way. The long history of a near layer smears by that; one layer is corrected where surfaces move apart.
TEST(RoundedVelocity, CostsTwoLayersAtMostAQuarterMoreThanOne) {
  EXPECT_LE(error_of(TemporalPreset::kBalanced, round_velocity),
            1.25 * error_of(TemporalPreset::kFast, round_velocity));
}

// What is spread can be taken back: most of what two layers gain is there again.
TEST(SpreadLayers, GainAlmostAsMuchOnceVelocityIsTakenBack) {
  const auto keep = [](HostFrame&) {};
  const double one = error_of(TemporalPreset::kFast, keep);
  const double two = error_of(TemporalPreset::kBalanced, keep);
  const double taken_back = error_of(TemporalPreset::kBalanced, spread_velocity, DrawnVelocity::kDilated);
  EXPECT_LT(taken_back - two, .2 * (one - two)) << one << " " << two << " " << taken_back;
  EXPECT_LE(error_of(TemporalPreset::kFast, spread_velocity, DrawnVelocity::kDilated), 1.02 * one);
}

TEST(ExactLayers, NoiseInDepthTakesNothing) {
  const double exact = error_of(TemporalPreset::kBalanced, [](HostFrame&) {});
  EXPECT_LE(error_of(TemporalPreset::kBalanced, shake_depth), 1.02 * exact);
}

}  // namespace
}  // namespace quincunx
