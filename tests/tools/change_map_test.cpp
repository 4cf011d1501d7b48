// SPDX-License-Identifier: MIT
#include "tools/image/change_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace quincunx::tools {
namespace {

constexpr Extent kExtent{24, 16};

// A ramp that has moved to the right by so many pixels, brighter by `light`.
MeasuredPicture ramp(float moved, float light = 0) {
  std::vector<float> rgba;
  for (int y = 0; y < kExtent.height; ++y) {
    for (int x = 0; x < kExtent.width; ++x) {
      const float luma = .2f + .02f * (static_cast<float>(x) - moved) + light;  // tone-mapped and encoded
      const float mapped = luma <= .04045f ? luma / 12.92f : std::pow((luma + .055f) / 1.055f, 2.4f);
      const float linear = mapped / (1 - mapped);
      rgba.insert(rgba.end(), {linear, linear, linear, 1});
    }
  }
  return MeasuredPicture(kExtent, rgba);
}

double mean(const std::vector<float>& map) {
  return std::accumulate(map.begin(), map.end(), 0.) / static_cast<double>(map.size());
}

TEST(FlickerMap, ItsMeanIsFlicker) {
  const MeasuredPicture now = ramp(1, .1f), before = ramp(0), truth = ramp(1), truth_before = ramp(.5f);
  EXPECT_NEAR(mean(flicker_map(now, before, truth, truth_before)), flicker(now, before, truth, truth_before),
              1e-6);
  EXPECT_EQ(mean(flicker_map(truth, truth_before, truth, truth_before)), 0);
}

TEST(GhostMap, WhatMotionExplainsIsDark) {
  constexpr float kMoved = 2.5f;
  const std::vector<Vec2> motion(6, Vec2{kMoved / kExtent.width, 0});
  const auto map = ghost_map(ramp(kMoved), ramp(0), {{3, 2}, motion});
  const std::vector<Vec2> none(6);
  const auto unexplained = ghost_map(ramp(kMoved), ramp(0), {{3, 2}, none});
  for (int y = 0; y < kExtent.height; ++y) {
    for (int x = 0; x < kExtent.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y * kExtent.width + x);
      // The source of column 2 lies half a pixel before the first centre.
      EXPECT_NEAR(map[i], x == 2 ? .01 : 0, 1e-5) << x;
      EXPECT_NEAR(unexplained[i], .02 * kMoved, 1e-5);
    }
  }
}

TEST(GhostMap, WhatRemainsShowsAndOffScreenIsDark) {
  const std::vector<Vec2> none(1), off(1, Vec2{2, 0}),
      bad(1, Vec2{std::numeric_limits<float>::quiet_NaN(), 0});
  for (const float value : ghost_map(ramp(0, .1f), ramp(0), {{1, 1}, none}))
    EXPECT_NEAR(value, .1, 1e-5);
  EXPECT_EQ(mean(ghost_map(ramp(0, .1f), ramp(0), {{1, 1}, off})), 0);
  EXPECT_EQ(mean(ghost_map(ramp(0, .1f), ramp(0), {{1, 1}, bad})), 0);
}

}  // namespace
}  // namespace quincunx::tools
