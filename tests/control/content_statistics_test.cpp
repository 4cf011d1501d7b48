// SPDX-License-Identifier: MIT
#include "quincunx/content_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace quincunx {
namespace {

double share(const SceneMix& mix, SceneClass scene_class) {
  return mix.share[static_cast<std::size_t>(scene_class)];
}

TEST(ContentStatistics, NothingMovesIsStill) {
  EXPECT_EQ(share(mix_of({}), SceneClass::kStill), 1);
}

TEST(ContentStatistics, EachPlaceCountsOnce) {
  const SceneMix mix = mix_of({.moving = 0.7, .apart = 0.3, .thin = 0.1, .light = 0.2, .zoom = 0.15});
  EXPECT_NEAR(share(mix, SceneClass::kLight), 0.2, 1e-12);
  EXPECT_NEAR(share(mix, SceneClass::kThin), 0.1, 1e-12);
  EXPECT_NEAR(share(mix, SceneClass::kObjects), 0.2, 1e-12);
  EXPECT_NEAR(share(mix, SceneClass::kZoom), 0.15, 1e-12);
  EXPECT_NEAR(share(mix, SceneClass::kPan), 0.25, 1e-12);
  EXPECT_NEAR(share(mix, SceneClass::kStill), 0.1, 1e-12);
}

TEST(ContentStatistics, EveryMixIsValid) {
  for (int code = 0; code < 243; ++code) {
    int rest = code;
    const auto third = [&rest] {
      const double value = (rest % 3) * 0.5;
      rest /= 3;
      return value;
    };
    const ContentStatistics content = {
        .moving = third(), .apart = third(), .thin = third(), .light = third(), .zoom = third()};
    const SceneMix mix = mix_of(content);
    ASSERT_TRUE(mix.valid()) << code;
    if (content.moving == 0) {
      ASSERT_EQ(share(mix, SceneClass::kPan), 0);
      ASSERT_EQ(share(mix, SceneClass::kZoom), 0);
    }
  }
}

TEST(ContentStatistics, BadFieldsAreNamed) {
  const double nan = std::nan("");
  const auto message = [](const ContentStatistics& content) { return check(content).message(); };
  for (const double bad : {nan, -0.1, 1.1}) {
    EXPECT_EQ(message({.moving = bad}).rfind("content.moving", 0), 0u);
    EXPECT_EQ(message({.apart = bad}).rfind("content.apart", 0), 0u);
    EXPECT_EQ(message({.thin = bad}).rfind("content.thin", 0), 0u);
    EXPECT_EQ(message({.light = bad}).rfind("content.light", 0), 0u);
    EXPECT_EQ(message({.zoom = bad}).rfind("content.zoom", 0), 0u);
  }
  for (const double bad : {nan, -1.0, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(message({.speed_px = bad}).rfind("content.speed_px", 0), 0u);
  EXPECT_TRUE(check(ContentStatistics{.moving = 1, .speed_px = 300, .apart = 1}).ok());
}

}  // namespace
}  // namespace quincunx
