// SPDX-License-Identifier: MIT
#include "passes/tables.h"

#include <algorithm>
#include <vector>

#include "kernel_fixture.h"

namespace quincunx {
namespace {

// Weights are multiples of 2^-24; the reference's own coordinate is good to far less.
constexpr double kWeightError = 0x1p-24;

// Where the two taps put the pixel, in texels: the clamped coordinate, if base and weights are right.
double position_of(const AxisTap& tap) {
  return static_cast<double>(tap.weight0) * tap.base + static_cast<double>(tap.weight1) * (tap.base + 1);
}

TEST(AxisTable, MatchesTheReferenceForEveryViewportTo64) {
  for (const float jitter : {-1.0f, -0.5f, -0.25f, 0.0f, 0.1234f, 0.25f, 0.5f}) {
    for (const int output : {1, 2, 7, 33, 64}) {
      for (int render = 1; render <= 64; ++render) {
        std::vector<AxisTap> taps(static_cast<std::size_t>(output));
        fill_axis(render, output, static_cast<double>(jitter), taps.data());
        for (int x = 0; x < output; ++x) {
          const AxisTap& tap = taps[static_cast<std::size_t>(x)];
          const auto expected = reference::bilinear_taps(x, output, render, static_cast<double>(jitter));
          const double position =
              expected[0].texel * expected[0].weight + expected[1].texel * expected[1].weight;
          ASSERT_NEAR(position_of(tap), position, kWeightError)
              << "pixel " << x << " of " << output << ", viewport " << render << ", jitter " << jitter;
          ASSERT_EQ(tap.weight0 + tap.weight1, 1.0f);
          ASSERT_GE(tap.weight0, 0.0f);
          ASSERT_GE(tap.weight1, 0.0f);
          ASSERT_GE(tap.base, 0);
          ASSERT_LE(tap.base + (render > 1 ? 1 : 0), render - 1);
          ASSERT_EQ(tap.nearest, reference::nearest_texel(x, output, render, static_cast<double>(jitter)))
              << "pixel " << x << " of " << output << ", viewport " << render << ", jitter " << jitter;
        }
      }
    }
  }
}

TEST(AxisTable, IsTheIdentityAtScaleOneWithoutJitter) {
  constexpr int kSize = 1279;
  std::vector<AxisTap> taps(kSize);
  fill_axis(kSize, kSize, 0, taps.data());
  for (int x = 0; x < kSize; ++x) {
    const AxisTap& tap = taps[static_cast<std::size_t>(x)];
    EXPECT_EQ(tap.nearest, x);
    EXPECT_EQ(tap.weight1 == 0 ? tap.base : tap.base + 1, x);
    EXPECT_TRUE(tap.weight1 == 0 || tap.weight1 == 1);
  }
}

TEST(AxisTable, ASampleMovedRightIsFoundFurtherLeft) {
  std::vector<AxisTap> plain(64);
  std::vector<AxisTap> jittered(64);
  fill_axis(64, 64, 0, plain.data());
  fill_axis(64, 64, 0.25, jittered.data());
  for (std::size_t x = 1; x < 64; ++x)
    EXPECT_EQ(position_of(jittered[x]), position_of(plain[x]) - 0.25);
}

TEST(AxisTables, KeepWhatWasUsedLatelyAndRefillTheRest_small) {
  const Device::Impl& impl = testing::impl();
  AxisTables tables(impl, {10, 6});
  constexpr std::size_t kRowAxis = 12;  // columns in whole blocks of four
  const auto read = [&](Extent render, Vec2 jitter) {
    const cl::Buffer& buffer = tables.get(impl.queue, {{10, 6}, render, jitter});
    std::vector<AxisTap> taps(kRowAxis + 6);
    impl.queue.enqueueReadBuffer(buffer, CL_TRUE, 0, taps.size() * sizeof(AxisTap), taps.data());
    return std::pair(buffer(), taps);
  };
  const auto first = read({7, 5}, {0.25f, 0.25f});
  EXPECT_EQ(read({7, 5}, {0.25f, 0.25f}).first, first.first);
  EXPECT_NE(read({7, 5}, {-0.25f, -0.25f}).first, first.first);
  for (int x = 10; x < 12; ++x)
    EXPECT_EQ(first.second[static_cast<std::size_t>(x)].base, first.second[9].base);
  // More viewports than slots, twice round: each time what comes back is right.
  for (int round = 0; round < 2; ++round) {
    for (int width = 1; width <= 20; ++width) {
      std::vector<AxisTap> columns(10);
      std::vector<AxisTap> rows(6);
      fill_axis(width, 10, 0, columns.data());
      fill_axis(width + 3, 6, 0, rows.data());
      const auto taps = read({width, width + 3}, {0, 0}).second;
      const auto same = [](const AxisTap& a, const AxisTap& b) {
        return a.base == b.base && a.weight1 == b.weight1 && a.nearest == b.nearest;
      };
      EXPECT_TRUE(std::equal(columns.begin(), columns.end(), taps.begin(), same));
      EXPECT_TRUE(std::equal(rows.begin(), rows.end(), taps.begin() + kRowAxis, same));
    }
  }
}

}  // namespace
}  // namespace quincunx
