// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_compare.h"

#include <gtest/gtest.h>

#include "bench/sample_result.h"

namespace quincunx::bench {
namespace {

using testing::sample_result;
using testing::spread;

Comparison compared(const BenchResult& after) {
  auto comparison = compare(sample_result(), after);
  EXPECT_TRUE(comparison.ok()) << comparison.status().message();
  return comparison.value();
}

void slow_down(Row& row, double factor) {
  row.speed.processor_ratio = spread(factor * row.speed.processor_ratio.median, 0.005);
}

TEST(Compare, AResultEqualsItself) {
  const Comparison comparison = compared(sample_result());
  EXPECT_TRUE(comparison.changes.empty());
  EXPECT_FALSE(comparison.worse());
  EXPECT_GT(comparison.same, 0);
}

TEST(Compare, ErrorsCountFromTheirThreshold) {
  BenchResult after = sample_result();
  after.rows[0].quality.flip += 0.0009;  // below 0.0005 + 0.5 %
  EXPECT_FALSE(compared(after).worse());
  after.rows[0].quality.flip += 0.0003;
  const Comparison worse = compared(after);
  ASSERT_EQ(worse.changes.size(), 1u);
  EXPECT_TRUE(worse.worse());
  EXPECT_EQ(worse.changes[0].measure, "FLIP");
  EXPECT_EQ(worse.changes[0].verdict, Verdict::kWorse);
  EXPECT_NE(text_of(worse).find("WORSE"), std::string::npos);

  after = sample_result();
  after.rows[0].quality.psnr += 1;
  EXPECT_FALSE(compared(after).worse());
  EXPECT_EQ(compared(after).changes.size(), 1u);
  after.rows[0].quality.psnr -= 2;
  EXPECT_TRUE(compared(after).worse());
}

TEST(Compare, ARegionCountsThoughTheMeanDoesNotChange) {
  BenchResult after = sample_result();
  auto& thin = after.rows[0].quality.region_psnr[static_cast<std::size_t>(Region::kThin)];
  thin = thin.value() - 0.2;
  const Comparison worse = compared(after);
  ASSERT_EQ(worse.changes.size(), 1u);
  EXPECT_EQ(worse.changes[0].measure, "PSNR of thin things, dB");
  EXPECT_TRUE(worse.worse());
  thin.reset();  // of before there were regions
  EXPECT_TRUE(compared(after).changes.empty());
}

TEST(Compare, ALongerHistoryIsAnotherMeasurement) {
  BenchResult other = sample_result();
  other.conditions.history_warm_up = 6;
  const auto refused = compare(sample_result(), other);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.status().message().find("--history-warm-up"), std::string::npos);
  other.conditions.history_warm_up.reset();  // of before there were methods that accumulate
  EXPECT_TRUE(compare(other, sample_result()).ok());
}

TEST(Compare, LosingAnInfiniteRatioIsWorse) {
  BenchResult after = sample_result();
  after.rows[1].quality.psnr = 90;
  EXPECT_TRUE(compared(after).worse());
}

TEST(Compare, OneNonFinitePixelIsWorse) {
  BenchResult after = sample_result();
  after.rows[3].quality.non_finite = 1;
  EXPECT_TRUE(compared(after).worse());
}

TEST(Compare, ASlowRowCountsWhereTheOthersStand) {
  BenchResult after = sample_result();
  slow_down(after.rows[2], 1.02);
  EXPECT_FALSE(compared(after).worse());
  slow_down(after.rows[2], 1.2);
  const Comparison comparison = compared(after);
  EXPECT_TRUE(comparison.worse());
  EXPECT_EQ(comparison.changes[0].measure, "cost, copies");
  EXPECT_EQ(comparison.changes[0].scale, 0.7);
}

TEST(Compare, ARowWithinTheNoiseOfAllRowsDoesNotCount) {
  BenchResult after = sample_result();
  const double factors[] = {1.08, 0.93, 0.92, 1.07, 1.10, 0.95, 0.90, 1.06};
  for (std::size_t i = 0; i < after.rows.size(); ++i)
    slow_down(after.rows[i], factors[i]);
  const Comparison comparison = compared(after);
  EXPECT_FALSE(comparison.worse());
  EXPECT_GT(comparison.cost_deviation, 0.05);
}

TEST(Compare, AMethodThatIsALittleSlowerEverywhereCounts) {
  BenchResult after = sample_result();
  for (std::size_t i = 1; i < after.rows.size(); i += 2) {
    slow_down(after.rows[i], 1.06);
    after.rows[i].speed.processor_ratio = spread(after.rows[i].speed.processor_ratio.median, 0.2);
  }
  const Comparison comparison = compared(after);
  ASSERT_EQ(comparison.changes.size(), 1u);
  EXPECT_EQ(comparison.changes[0].scene, "all");
  EXPECT_EQ(comparison.changes[0].method, "quincunx:mean");
  EXPECT_TRUE(comparison.worse());
}

TEST(Compare, CostsOfAnotherMachineAreLeftOut) {
  BenchResult after = sample_result();
  for (Row& row : after.rows)
    slow_down(row, 3);
  EXPECT_TRUE(compared(after).worse());
  after.machine.cl_driver = "another";
  EXPECT_FALSE(compared(after).worse());
  EXPECT_EQ(compared(after).notes.size(), 1u);
}

TEST(Compare, NamesWhatOneResultLacks) {
  BenchResult after = sample_result();
  after.rows[0].method = "new";
  const Comparison comparison = compared(after);
  EXPECT_EQ(comparison.missing, std::vector<std::string>{"pan, 0.5, bilinear"});
  EXPECT_EQ(comparison.added, std::vector<std::string>{"pan, 0.5, new"});
  EXPECT_FALSE(comparison.worse());
}

TEST(Compare, RefusesOtherConditions) {
  BenchResult after = sample_result();
  after.conditions.seed = 7;
  const auto comparison = compare(sample_result(), after);
  ASSERT_FALSE(comparison.ok());
  EXPECT_NE(comparison.status().message().find("--seed"), std::string::npos);
}

}  // namespace
}  // namespace quincunx::bench
