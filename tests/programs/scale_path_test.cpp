// SPDX-License-Identifier: MIT
#include "programs/scale_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace quincunx::scenes {
namespace {

ScalePath path(const std::string& text, std::uint64_t seed = 0) {
  auto result = ScalePath::parse(text, seed);
  EXPECT_TRUE(result.ok()) << result.status().message();
  return result.value();
}

TEST(ScalePath, SweepGoesUpAndDown) {
  const ScalePath sweep = path("sweep");
  EXPECT_FLOAT_EQ(sweep.at(0, 241).x, 0.5f);
  EXPECT_FLOAT_EQ(sweep.at(60, 241).x, 0.75f);
  EXPECT_FLOAT_EQ(sweep.at(120, 241).x, 1.0f);
  EXPECT_FLOAT_EQ(sweep.at(240, 241).y, 0.71f);
  EXPECT_FLOAT_EQ(sweep.largest(), 1.0f);
}

TEST(ScalePath, RampIsLinear) {
  const ScalePath ramp = path("ramp:2,0.5");
  EXPECT_FLOAT_EQ(ramp.at(0, 4).x, 2.0f);
  EXPECT_FLOAT_EQ(ramp.at(1, 4).x, 1.5f);
  EXPECT_FLOAT_EQ(ramp.at(3, 4).x, 0.5f);
  EXPECT_FLOAT_EQ(ramp.largest(), 2.0f);
  EXPECT_FLOAT_EQ(ramp.at(0, 1).x, 2.0f) << "a run of one frame shows the start";
}

TEST(ScalePath, RandomIsBoundedFreePerAxisAndRepeatable) {
  const ScalePath random = path("random:0.3,0.9", 5);
  std::set<float> seen;
  for (int i = 0; i < 1000; ++i) {
    const Vec2 scale = random.at(i, 1000);
    EXPECT_GE(std::min(scale.x, scale.y), 0.3f);
    EXPECT_LE(std::max(scale.x, scale.y), 0.9f);
    EXPECT_EQ(scale, path("random:0.3,0.9", 5).at(i, 1000));
    seen.insert(scale.x);
    seen.insert(scale.y);
  }
  EXPECT_GT(seen.size(), 1900u);
  EXPECT_NE(random.at(3, 1000), path("random:0.3,0.9", 6).at(3, 1000));
}

TEST(ScalePath, BadTextIsRefusedWithWhatWouldBeRight) {
  for (const char* text : {"", "swep", "sweep:", "sweep:1,2", "ramp:0,1", "ramp:0.5,3", "ramp:a,b",
                           "ramp:.5,nan", "random:0.5,0.6,0.7", "random:0.5;0.6"}) {
    const auto result = ScalePath::parse(text, 0);
    ASSERT_FALSE(result.ok()) << text;
    EXPECT_EQ(result.status().code(), StatusCode::kInvalidArgument);
    EXPECT_NE(result.status().message().find("scale"), std::string::npos) << result.status().message();
  }
  EXPECT_FALSE(ScalePath::fixed({0, 1}).ok());
  EXPECT_FALSE(ScalePath::fixed({1, 2.5f}).ok());
}

}  // namespace
}  // namespace quincunx::scenes
