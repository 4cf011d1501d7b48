// SPDX-License-Identifier: MIT
#include "tools/sequence/exchange_format.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace quincunx::tools {
namespace {

// One division each way, correctly rounded: two half units in the last place, and a little for their product.
constexpr double kTwoDivisions = 2.5 * std::numeric_limits<float>::epsilon();

TEST(ExchangeFormat, DepthIsDistanceAlongTheAxis) {
  EXPECT_EQ(linear_z(1.0f, 0.25f), 0.25f);  // on the near plane
  EXPECT_EQ(linear_z(0.5f, 0.25f), 0.5f);
  EXPECT_EQ(linear_z(0.001953125f, 0.125f), 64.0f);
}

TEST(ExchangeFormat, NoSurfaceIsFarButFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float tiny = std::numeric_limits<float>::denorm_min();
  for (const float depth : {0.0f, -0.0f, -1.0f, nan, tiny}) {
    EXPECT_EQ(linear_z(depth, 0.1f), kNoSurfaceZ) << depth;
  }
  EXPECT_EQ(reversed_depth(kNoSurfaceZ, 0.1f), 0.0f);
  EXPECT_EQ(reversed_depth(std::numeric_limits<float>::infinity(), 0.1f), 0.0f);
  EXPECT_EQ(reversed_depth(nan, 0.1f), 0.0f);
  EXPECT_EQ(reversed_depth(0.01f, 0.1f), 1.0f);  // before the near plane
}

TEST(ExchangeFormat, DepthReturns) {
  for (float depth = 1.0f; depth > 1e-9f; depth *= 0.83f) {
    EXPECT_NEAR(reversed_depth(linear_z(depth, 0.1f), 0.1f), depth, depth * kTwoDivisions);
  }
}

// A surface that was at pixel (100, 40) and is at (104, 38) now, rows top-down: it moved right and up, so the
// way back is left and down, and down is negative in Nuke's sense.
TEST(ExchangeFormat, VelocityTurnsAround) {
  const Extent extent{640, 360};
  const Vec2 velocity{(104.0f - 100.0f) / 640.0f, (38.0f - 40.0f) / 360.0f};
  const Vec2 backward = backward_from_velocity(velocity, extent);
  EXPECT_FLOAT_EQ(backward.x, -4.0f);
  EXPECT_FLOAT_EQ(backward.y, -2.0f);
  const Vec2 returned = velocity_from_backward(backward, extent);
  EXPECT_FLOAT_EQ(returned.x, velocity.x);
  EXPECT_FLOAT_EQ(returned.y, velocity.y);
}

}  // namespace
}  // namespace quincunx::tools
