// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "tools/record/exchange_format.h"

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

constexpr double kEpsilon = std::numeric_limits<float>::epsilon();

Vec2 converted(const VelocityUnits& units, Extent extent, Vec2 motion) {
  to_velocity(units, extent, {&motion, 1});
  return motion;
}

// A surface that was at pixel (100, 40) and is at (104, 38) now, rows top-down, in an image of 640x360.
TEST(Velocity, EveryConventionSaysTheSameMotion) {
  const Extent extent{640, 360};
  const Vec2 velocity{4.0f / 640, -2.0f / 360};
  using enum VelocityConvention;
  const auto expect = [&](const VelocityUnits& units, Vec2 motion) {
    const Vec2 result = converted(units, extent, motion);
    EXPECT_FLOAT_EQ(result.x, velocity.x) << name_of(units.convention);
    EXPECT_FLOAT_EQ(result.y, velocity.y) << name_of(units.convention);
  };
  expect({kNuke, {}}, {-4, -2});  // back to the left and, as v is up, down
  expect({kBlender, {}}, {-4, -2});
  expect({kFsr2, {}}, {-4, 2});
  expect({kNdc, {}}, {2 * velocity.x, -2 * velocity.y});  // current - previous, 2 wide, y up
  expect({kScale, {1, 1}}, velocity);
  expect({kScale, {-1.0f / 640, -1.0f / 360}}, {-4, 2});
}

// A renderer's half velocity in uv goes into files as pixels and returns bit for bit: a half has 11 bits, an extent of
// up to 8192 has 13, and their product fits into a float's 24.
TEST(Velocity, HalvesReturnBitForBit) {
  for (const Extent extent : {Extent{909, 511}, Extent{1280, 720}, Extent{8191, 4095}, Extent{1, 3}}) {
    for (int exponent = -14; exponent <= 2; ++exponent) {
      for (int mantissa = 1024; mantissa < 2048; mantissa += 7) {
        const float half = std::ldexp(static_cast<float>(mantissa), exponent - 10);
        const Vec2 stored = {-half * static_cast<float>(extent.width),
                             -half * static_cast<float>(extent.height)};
        const Vec2 returned = converted({VelocityConvention::kNuke, {}}, extent, stored);
        ASSERT_EQ(returned.x, half) << extent.width;
        ASSERT_EQ(returned.y, -half) << extent.height;
      }
    }
  }
}

float reversed(DepthKind kind, float near_plane, float depth) {
  to_reversed_depth(kind, near_plane, {&depth, 1});
  return depth;
}

TEST(Depth, EveryKindSaysTheSameDistance) {
  EXPECT_FLOAT_EQ(reversed(DepthKind::kLinear, 0.25f, 2.0f), 0.125f);
  EXPECT_FLOAT_EQ(reversed(DepthKind::kDevice, 0, 0.875f), 0.125f);
  EXPECT_FLOAT_EQ(reversed(DepthKind::kDeviceReversed, 0, 0.125f), 0.125f);
}

TEST(Depth, NothingSeenIsInfinitelyFar) {
  for (const DepthKind kind : {DepthKind::kLinear, DepthKind::kDevice, DepthKind::kDeviceReversed})
    EXPECT_EQ(reversed(kind, 0.1f, nothing_seen(kind)), 0.0f) << name_of(kind);
  const float infinite = std::numeric_limits<float>::infinity();
  for (const float z : {0.0f, -1.0f, 1e10f, 1e30f, infinite, std::numeric_limits<float>::quiet_NaN()})
    EXPECT_EQ(reversed(DepthKind::kLinear, 0.1f, z), 0.0f) << z;
}

TEST(Depth, DeviceReversedStaysBitForBit) {
  const float odd[] = {0.1f, -0.0f, 1e-40f, std::numeric_limits<float>::quiet_NaN(), -3.0f};
  float values[std::size(odd)];
  std::memcpy(values, odd, sizeof odd);
  to_reversed_depth(DepthKind::kDeviceReversed, 0.1f, values);
  EXPECT_EQ(std::memcmp(values, odd, sizeof odd), 0);
}

TEST(Depth, NamesReturn) {
  for (const DepthKind kind : {DepthKind::kLinear, DepthKind::kDevice, DepthKind::kDeviceReversed})
    EXPECT_EQ(depth_kind_named(name_of(kind)), kind);
  EXPECT_FALSE(depth_kind_named("Linear"));
}

// Column-major clip from world of a camera at (x, 0, 0) that looks along -z, 90 degrees wide; `a` and `b`:
// what its z row makes of the distance, which must not matter.
Matrix looking_along_z(float x, float a, float b) {
  Matrix m = {};
  m[0] = 1;
  m[12] = -x;
  m[5] = 1;
  m[10] = a;
  m[14] = b;
  m[11] = -1;  // w = -z
  return m;
}

TEST(Camera, PointsGoWhereTheyWere) {
  constexpr float kNear = 0.5f;
  const Matrix now = looking_along_z(3, -1.01f, -0.2f);
  const Matrix before = looking_along_z(2.5f, -1.01f, -0.2f);
  const auto motion = camera_motion(now, before, kNear);
  ASSERT_TRUE(motion);
  const auto& m = motion->clip_to_previous_clip;
  for (const Vec2 ndc : {Vec2{0, 0}, Vec2{-0.5f, 0.75f}}) {
    for (const float distance : {0.5f, 4.0f, 100.0f}) {
      const float point[4] = {ndc.x, ndc.y, kNear / distance, 1};
      double clip[4] = {};
      for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t column = 0; column < 4; ++column)
          clip[row] += double{m[4 * column + row]} * point[column];
      }
      // The point stands half a unit to the right of where the camera saw it: 0.5 / distance in ndc. Sixteen
      // rounded elements and four rounded products a row.
      constexpr double kBound = 8 * kEpsilon;
      EXPECT_NEAR(clip[0] / clip[3], ndc.x + 0.5 / distance, kBound);
      EXPECT_NEAR(clip[1] / clip[3], ndc.y, kBound);
      EXPECT_NEAR(clip[2] / clip[3], kNear / distance, kBound);
    }
  }
}

TEST(Camera, EqualMatricesAreExactlyNoMotion) {
  const Matrix any = looking_along_z(0.1f, -1.3f, -0.7f);
  const auto motion = camera_motion(any, any, 0.1f);
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->clip_to_previous_clip, CameraMotion{}.clip_to_previous_clip);
}

TEST(Camera, MatricesThatCannotBeInvertedAreRefused) {
  const Matrix good = looking_along_z(0, -1, -1);
  EXPECT_FALSE(camera_motion(Matrix{}, good, 0.1f));
  EXPECT_FALSE(camera_motion(Matrix{}, Matrix{}, 0.1f));
  Matrix bad = good;
  bad[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(camera_motion(bad, good, 0.1f));
  EXPECT_FALSE(camera_motion(good, bad, 0.1f));
}

}  // namespace

}  // namespace quincunx::tools
