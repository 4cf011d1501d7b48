// SPDX-License-Identifier: MIT
#include "tools/image/display_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace quincunx::tools {
namespace {

TEST(DisplayLight, EncodedValuesHaveTheirLight) {
  EXPECT_EQ(linear_of_srgb(0), 0);
  EXPECT_EQ(linear_of_srgb(1), 1);
  EXPECT_NEAR(linear_of_srgb(0.5f), 0.2140411, 1e-6);
  EXPECT_NEAR(linear_of_srgb(0.04f), 0.04 / 12.92, 1e-8);
}

TEST(DisplayLight, CurvesTakeExposedColoursAndLeaveAlpha) {
  const std::vector<float> rgba = {0.5f, 2, -1, 0.25f};
  EXPECT_EQ(display_light(rgba, ToneMap::kClamp, 1), (std::vector<float>{0.5f, 1, 0, 0.25f}));
  EXPECT_EQ(display_light(rgba, ToneMap::kReinhard, 2), (std::vector<float>{0.5f, 0.8f, 0, 0.25f}));
  const std::vector<float> aces = display_light(rgba, ToneMap::kAces, 1);
  EXPECT_NEAR(aces[0], 0.5 * (2.51 * 0.5 + 0.03) / (0.5 * (2.43 * 0.5 + 0.59) + 0.14), 1e-6);
  EXPECT_EQ(aces[3], 0.25f);
}

TEST(DisplayLight, ValuesThatAreNotFiniteStayWithinTheScreen) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const ToneMap tone_map : {ToneMap::kClamp, ToneMap::kReinhard, ToneMap::kAces}) {
    const auto shown = display_light(std::vector<float>{std::nanf(""), infinity, -infinity, 1}, tone_map, 1);
    EXPECT_EQ(shown[0], 0);
    EXPECT_GT(shown[1], 0.99f);
    EXPECT_LE(shown[1], 1);
    EXPECT_EQ(shown[2], 0);
  }
}

TEST(DisplayLight, ReinhardIsTakenBack) {
  const std::vector<float> light = {0, 0.125f, 3, 0.5f, 100, 0.001f, 1, 1};
  const auto back = light_before_reinhard(display_light(light, ToneMap::kReinhard, 1));
  for (std::size_t i = 0; i < light.size(); ++i)
    EXPECT_NEAR(back[i], light[i], 1e-4f * light[i] * (1 + light[i])) << i;
  const auto brightest = light_before_reinhard(std::vector<float>{1, 0, 0, 1});
  EXPECT_TRUE(std::isfinite(brightest[0]));
}

}  // namespace
}  // namespace quincunx::tools
