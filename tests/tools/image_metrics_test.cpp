// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "tools/image/image_metrics.h"

namespace quincunx::tools {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Sums of some thousand float values of order 1, each exact to 2^-24, taken in double.
constexpr double kRounding = 1e-6;

std::vector<float> plain(Extent extent, float value) {
  return std::vector<float>(static_cast<std::size_t>(extent.area()) * 4, value);
}

std::vector<float> noise(Extent extent, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<float> values(static_cast<std::size_t>(extent.area()) * 4);
  for (float& value : values)
    value = static_cast<float>(random() % 2048) / 1024;
  return values;
}

void paint(std::vector<float>& rgba, Extent extent, int x, int y, float value) {
  for (int c = 0; c < 3; ++c)
    rgba[static_cast<std::size_t>((y * extent.width + x) * 4 + c)] = value;
}

// Returns the value that the metrics call tone mapped, in double.
double shown(double linear) {
  const double mapped = linear / (1 + linear);
  return mapped <= 0.0031308 ? 12.92 * mapped : 1.055 * std::pow(mapped, 1 / 2.4) - 0.055;
}

TEST(MeasuredPicture, CleansAndCountsWhatIsNotFinite) {
  const Extent extent{11, 11};
  std::vector<float> rgba = plain(extent, -1);
  rgba[0] = kNan;
  rgba[1] = kInfinity;
  rgba[2] = -kInfinity;
  rgba[4 * 7 + 1] = kInfinity;
  rgba[4 * 9 + 3] = kNan;  // alpha does not matter
  const MeasuredPicture picture(extent, rgba);
  EXPECT_EQ(picture.non_finite(), 2);
  EXPECT_EQ(picture.linear()[0], 0);
  EXPECT_EQ(picture.linear()[1], 65504);
  EXPECT_EQ(picture.linear()[2], -65504);
  EXPECT_EQ(picture.tone_mapped()[2], 0) << "negative light is shown as black";
  EXPECT_NEAR(double{picture.tone_mapped()[1]}, shown(65504), kRounding);
}

TEST(Psnr, OfAKnownDifference) {
  const Extent extent{16, 12};
  const MeasuredPicture truth(extent, plain(extent, 0.25f));
  EXPECT_NEAR(psnr_linear(MeasuredPicture(extent, plain(extent, 0.35f)), truth), 20, 1e-5);
  // Both clip to 1.
  EXPECT_EQ(psnr_linear(MeasuredPicture(extent, plain(extent, 7)), MeasuredPicture(extent, plain(extent, 9))),
            std::numeric_limits<double>::infinity());
  const double difference = shown(7) - shown(0.25);
  EXPECT_NEAR(psnr_tone_mapped(MeasuredPicture(extent, plain(extent, 7)), truth),
              -20 * std::log10(difference), 1e-5);
}

TEST(Ssim, OfConstantsFollowsTheFormula) {
  const Extent extent{13, 30};
  const MeasuredPicture a(extent, plain(extent, 0.5f));
  const MeasuredPicture b(extent, plain(extent, 2));
  const double x = shown(0.5), y = shown(2), c1 = 1e-4;
  EXPECT_NEAR(ssim(a, b), (2 * x * y + c1) / (x * x + y * y + c1), kRounding * 10);
  EXPECT_NEAR(ssim(a, a), 1, kRounding);
}

// One window of 11x11: the sums written out.
TEST(Ssim, OfOneWindow) {
  const Extent extent{11, 11};
  const MeasuredPicture a(extent, noise(extent, 1)), b(extent, noise(extent, 2));
  double weights = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  for (int i = 0; i < 121; ++i) {
    const double u = i % 11 - 5, v = static_cast<double>(i / 11) - 5;
    const double weight = std::exp(-(u * u + v * v) / 4.5);
    const double p = a.luma()[static_cast<std::size_t>(i)], q = b.luma()[static_cast<std::size_t>(i)];
    weights += weight;
    x += weight * p;
    y += weight * q;
    xx += weight * p * p;
    yy += weight * q * q;
    xy += weight * p * q;
  }
  x /= weights;
  y /= weights;
  const double vx = xx / weights - x * x, vy = yy / weights - y * y, covariance = xy / weights - x * y;
  const double expected =
      (2 * x * y + 1e-4) * (2 * covariance + 9e-4) / ((x * x + y * y + 1e-4) * (vx + vy + 9e-4));
  EXPECT_NEAR(ssim(a, b), expected, 1e-9);
}

TEST(ErrorP99, IsTheLevelThatOnePercentExceeds) {
  const Extent extent{20, 50};
  std::vector<float> rgba = plain(extent, 0);
  for (int i = 0; i < 11; ++i)
    paint(rgba, extent, i, 3, i < 9 ? 1 : 0.125f);
  const MeasuredPicture truth(extent, plain(extent, 0));
  EXPECT_NEAR(error_p99(MeasuredPicture(extent, rgba), truth), shown(0.125), kRounding);
}

TEST(RelativeError, WeighsByTheTruth) {
  const Extent extent{11, 11};
  const MeasuredPicture truth(extent, plain(extent, 100));
  EXPECT_NEAR(relative_error(MeasuredPicture(extent, plain(extent, 110)), truth), 100 / (10000 + 0.01),
              kRounding);
}

TEST(WorstWindow, IsFoundAtItsPlace) {
  const Extent extent{61, 47};
  std::vector<float> rgba = plain(extent, 0);
  for (const int x : {30, 45})
    for (const int y : {20, 35})
      paint(rgba, extent, x, y, 1);
  const MeasuredPicture truth(extent, plain(extent, 0));
  const WorstWindow worst = worst_window(MeasuredPicture(extent, rgba), truth);
  EXPECT_EQ(worst.x, 30);
  EXPECT_EQ(worst.y, 20);
  EXPECT_NEAR(worst.error, shown(1) * std::sqrt(4.0 / 256), kRounding);
}

TEST(Flicker, IsWhatTheTruthDoesNotHave) {
  const Extent extent{12, 12};
  const MeasuredPicture dark(extent, plain(extent, 0)), bright(extent, plain(extent, 1));
  EXPECT_EQ(flicker(bright, dark, bright, dark), 0);
  EXPECT_NEAR(flicker(bright, dark, dark, dark), shown(1), kRounding);
  EXPECT_NEAR(flicker(dark, bright, bright, dark), 2 * shown(1), kRounding);
}

TEST(Measure, TakesTheScoresOfOneFrame) {
  const Extent extent{40, 33};
  const MeasuredPicture picture(extent, noise(extent, 3)), truth(extent, noise(extent, 4));
  const PictureScores scores = measure(picture, truth);
  EXPECT_EQ(scores.psnr_linear, psnr_linear(picture, truth));
  EXPECT_EQ(scores.ssim, ssim(picture, truth));
  EXPECT_EQ(scores.error_p99, error_p99(picture, truth));
  EXPECT_GT(scores.flip, 0);
  EXPECT_LT(scores.flip, 1);
  const PictureScores equal = measure(truth, truth);
  EXPECT_EQ(equal.psnr_tone_mapped, std::numeric_limits<double>::infinity());
  EXPECT_EQ(equal.flip, 0);
  EXPECT_EQ(equal.worst_window.error, 0);
}

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
