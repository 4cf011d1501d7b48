// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bench/sample_result.h"
#include "bench/speed_error/bench_findings.h"

namespace quincunx::bench {
namespace {

TEST(Statistics, MedianAndPercentileOfKnownLists) {
  EXPECT_EQ(median_of({3, 1, 2}), 2);
  EXPECT_EQ(median_of({4, 1, 3, 2}), 2.5);
  EXPECT_EQ(median_of({7}), 7);
  EXPECT_EQ(least_median_of({{9, 1, 8}, {}, {4, 5, 6, 7}}), 5.5);
  Samples hundred;
  for (int i = 100; i >= 1; --i)
    hundred.push_back(i);
  EXPECT_EQ(p95_of(hundred), 95);
  EXPECT_EQ(p95_of({1, 2, 3}), 3);
  EXPECT_EQ(mean_of({1, 2, 6}), 3);
  EXPECT_DOUBLE_EQ(deviation_of_mean({1, 3}), 1);  // s = sqrt(2), of two
}

TEST(Statistics, TheIntervalHoldsTheMedianAndShowsTheSpreadOfRounds) {
  const Spread steady = spread_of({{5, 5}, {5, 5}, {5, 5}});
  EXPECT_EQ(steady, (Spread{.median = 5, .p95 = 5, .low = 5, .high = 5}));
  EXPECT_EQ(relative_noise(steady), 0);

  const Spread wide = spread_of({{1, 1}, {2, 2}, {3, 3}});
  EXPECT_EQ(wide.median, 2);
  EXPECT_EQ(wide.low, 1);
  EXPECT_EQ(wide.high, 3);
  EXPECT_DOUBLE_EQ(relative_noise(wide), 0.5);
  EXPECT_EQ(spread_of({{1, 2}, {9, 3}, {5}}), spread_of({{1, 2}, {9, 3}, {5}}));
  EXPECT_EQ(spread_of({{}, {4}, {}}).median, 4);
  EXPECT_EQ(spread_of({}), Spread{});
}

TEST(Statistics, RatiosAreFormedWithinTheirRound) {
  // A machine twice as slow in the second round changes no ratio.
  const Spread ratio = ratio_of({{3, 3}, {6, 6}}, {{1, 1}, {2, 2}});
  EXPECT_EQ(ratio, (Spread{.median = 3, .p95 = 3, .low = 3, .high = 3}));
}

TEST(Statistics, TheFrontHoldsWhatNothingBeats) {
  const std::vector<Point> points = {{1, 5}, {2, 3}, {2, 4}, {3, 3}, {4, 1}, {1, 5}};
  EXPECT_EQ(pareto_front(points), (std::vector<bool>{true, true, false, false, true, true}));
}

TEST(Statistics, FrontsAreThoseOfTheirSceneScaleAndMeasure) {
  BenchResult result = testing::sample_result();
  mark_fronts(result.rows);
  const auto has = [](const Row& row, const std::string& name) {
    return std::count(row.front.begin(), row.front.end(), name) == 1;
  };
  EXPECT_TRUE(has(result.rows[0], "flip"));
  EXPECT_TRUE(has(result.rows[1], "flip"));
  EXPECT_TRUE(has(result.rows[1], "psnr"));
  EXPECT_FALSE(has(result.rows[1], "ssim"));     // no better, and slower
  EXPECT_FALSE(has(result.rows[0], "flicker"));  // it has none
  EXPECT_TRUE(has(result.rows[1], "flicker"));
}

TEST(Findings, MeansOfRegionsAreThoseOfTheScenesThatHaveThem) {
  BenchResult result = testing::sample_result();
  result.scenes.push_back({"other", "", "", 0, 0, {}});
  Row other = result.rows[0];
  other.scene = "other";
  other.quality.region_psnr = {10, {}, 15, {}, {}};
  result.rows.push_back(other);
  const MethodMean mean = method_means(result).front();
  EXPECT_NEAR(mean.region_psnr[0].value(), -10 * std::log10((0.1 + 0.01) / 2), 1e-9);  // 10 and 20 dB
  EXPECT_NEAR(mean.region_psnr[1].value(), 28, 1e-9);
  EXPECT_NEAR(mean.region_psnr[2].value(), 15, 1e-9);
  EXPECT_FALSE(mean.region_psnr[3].has_value());
}

TEST(Findings, SpeakOfTheSample) {
  const BenchResult result = testing::sample_result();
  const auto seventy = seventy_percent(result);
  ASSERT_TRUE(seventy.has_value());
  EXPECT_EQ(seventy->scale, 0.7);
  EXPECT_DOUBLE_EQ(seventy->wall, 0.7);
  EXPECT_NEAR(typical_noise(result).cost, 0.00375, 1e-12);  // the mean of 0.005 / 1 and 0.005 / 2
  EXPECT_NEAR(typical_noise(result).ms, 0.0075, 1e-12);
  EXPECT_FALSE(findings_of(result).empty());
  EXPECT_TRUE(findings_of(BenchResult{}).empty());
  EXPECT_NE(text_of(result).find("quincunx:mean"), std::string::npos);

  BenchResult without = result;
  without.frames.pop_back();  // scale 1
  EXPECT_FALSE(seventy_percent(without).has_value());
}

}  // namespace
}  // namespace quincunx::bench
