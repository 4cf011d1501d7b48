// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/sample_result.h"
#include "bench/speed_error/bench_compare.h"
#include "bench/speed_error/bench_findings.h"
#include "bench/speed_error/bench_page.h"
#include "bench/speed_error/bench_result.h"
#include "bench/speed_error/bench_statistics.h"

namespace quincunx::bench {
namespace {

using testing::sample_result;

TEST(Result, ComesBackFromJson) {
  const auto back = from_json(to_json(sample_result()), "x.json");
  ASSERT_TRUE(back.ok()) << back.status().message();
  EXPECT_EQ(back.value(), sample_result());
  EXPECT_EQ(to_json(back.value()), to_json(sample_result()));
}

TEST(Result, ComesBackFromTables) {
  const std::string text = to_tables(sample_result());
  const auto back = from_json(text, "x.json");
  ASSERT_TRUE(back.ok()) << back.status().message();
  EXPECT_EQ(back.value(), sample_result());
  EXPECT_EQ(to_tables(back.value()), text);
}

TEST(Result, TablesNameAFieldOnceAndHaveALineARow) {
  const std::string text = to_tables(sample_result());
  EXPECT_EQ(text.find("worst_window"), text.rfind("worst_window"));
  EXPECT_LT(text.size(), to_json(sample_result()).size() / 2);
  for (const char* begin : {"\n[\"pan\",0.5,\"bilinear\",", "\n[\"pan\",0.7,\"quincunx:mean\","})
    EXPECT_NE(text.find(begin), std::string::npos) << begin;
  // An empty list is no table.
  EXPECT_EQ(from_json(to_tables(BenchResult()), "x.json").value(), BenchResult());
}

TEST(Result, RefusesARowThatDoesNotFillItsTable) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(to_tables(sample_result()));
  json["rows"]["data"][1].erase(0);
  const auto back = from_json(json.dump(), "short.json");
  ASSERT_FALSE(back.ok());
  EXPECT_NE(back.status().message().find("short.json"), std::string::npos);
}

TEST(Result, ReadsTheFormatBefore) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(to_json(sample_result()));
  json["format"] = 1;
  for (auto& scene : json["scenes"]) {
    scene["uncovered"] = scene["disoccluded"];
    scene.erase("disoccluded");
  }
  const auto back = from_json(json.dump(), "old.json");
  ASSERT_TRUE(back.ok()) << back.status().message();
  EXPECT_EQ(back.value(), sample_result());
}

TEST(Result, JsonHasNoNumberThatIsNone) {
  const auto json = nlohmann::json::parse(to_json(sample_result()));
  EXPECT_TRUE(json["rows"][1]["quality"]["psnr"].is_null());     // infinite
  EXPECT_TRUE(json["rows"][0]["quality"]["flicker"].is_null());  // absent
  EXPECT_EQ(json["rows"][1]["quality"]["flicker"], 0.25);
}

void expect_refused(const std::string& text) {
  const auto result = from_json(text, "old.json");
  ASSERT_FALSE(result.ok()) << text;
  EXPECT_NE(result.status().message().find("old.json"), std::string::npos);
}

TEST(Result, RefusesWhatIsNone) {
  expect_refused("");
  expect_refused("{}");
  expect_refused("[1, 2]");
  expect_refused(R"({"program": "quincunx-render", "format": 1})");
  nlohmann::json json = nlohmann::json::parse(to_json(sample_result()));
  json["format"] = kResultFormat + 1;
  expect_refused(json.dump());
  json["format"] = kResultFormat;
  ASSERT_TRUE(from_json(json.dump(), "x").ok());
  json["rows"][2]["quality"].erase("flip");
  expect_refused(json.dump());
  json = nlohmann::json::parse(to_json(sample_result()));
  json["rows"][2]["speed"]["kernels"] = 3;
  expect_refused(json.dump());
  EXPECT_FALSE(read_result("/no/such/file.json").ok());
}

TEST(Result, ReadsOneOfBeforeThereWasHistory) {
  nlohmann::json json = nlohmann::json::parse(to_json(sample_result()));
  json["conditions"].erase("history_warm_up");
  const auto old = from_json(json.dump(), "old.json");
  ASSERT_TRUE(old.ok()) << old.status().message();
  EXPECT_FALSE(old->conditions.history_warm_up.has_value());
}

TEST(Result, ReadsOneOfBeforeThereWereRegions) {
  nlohmann::json json = nlohmann::json::parse(to_json(sample_result()));
  EXPECT_EQ(json["rows"][0]["quality"]["psnr_thin"], 20);
  EXPECT_TRUE(json["rows"][0]["quality"]["psnr_edge"].is_null());
  for (const char* region : {"thin", "behind_thin", "disoccluded", "edge", "rest"}) {
    for (auto& row : json["rows"])
      ASSERT_EQ(row["quality"].erase(std::string("psnr_") + region), 1u);
    for (auto& scene : json["scenes"])
      ASSERT_EQ(scene.erase(std::string("part_") + region), 1u);
  }
  const auto old = from_json(json.dump(), "old.json");
  ASSERT_TRUE(old.ok()) << old.status().message();
  EXPECT_EQ(old->rows[0].quality.region_psnr, RegionFigures());
  EXPECT_EQ(old->scenes[0].region_part, RegionFigures());
}

TEST(Result, CsvHasALineARowAndQuotesItsText) {
  BenchResult result = sample_result();
  result.rows[0].scene = "a \"b\", c";
  const std::string csv = to_csv(result);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + static_cast<int>(result.rows.size()));
  const std::string names = csv.substr(0, csv.find('\n'));
  EXPECT_EQ(names.rfind("scene,scale,method,render_width,", 0), 0u) << names;
  EXPECT_NE(names.find(",quality_flip,"), std::string::npos);
  EXPECT_NE(names.find(",speed_ms_median,"), std::string::npos);
  EXPECT_NE(names.find(",quality_psnr_behind_thin,"), std::string::npos);
  EXPECT_NE(csv.find("\n\"a \"\"b\"\", c\",0.5,bilinear,32,18,"), std::string::npos) << csv;
  const std::string last = csv.substr(csv.rfind('\n', csv.size() - 2) + 1);
  EXPECT_EQ(std::count(last.begin(), last.end(), ','), std::count(names.begin(), names.end(), ','));
}

TEST(Plot, HasAPointAMethodAndNoBadNumber) {
  const std::string svg = plot_of(sample_result());
  std::size_t circles = 0;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1))
    ++circles;
  EXPECT_EQ(circles, sample_result().methods.size());
  EXPECT_NE(svg.find(">quincunx:mean</text>"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(plot_of(BenchResult{}), "");
}

TEST(Page, IsOneFileThatNothingInItEnds) {
  const auto count = [](const std::string& page, const std::string& text) {
    int found = 0;
    for (std::size_t at = page.find(text); at != std::string::npos; at = page.find(text, at + 1))
      ++found;
    return found;
  };
  const std::string whole = page_of(sample_result(), {});
  setenv("QUINCUNX_CHART_JS", "/no/such/chart.js", 1);
  const std::string own = page_of(sample_result(), {});
  unsetenv("QUINCUNX_CHART_JS");
  EXPECT_EQ(count(whole, "</script>"), 3);  // data, library and script; the scene's words hold one more
  EXPECT_EQ(count(whole, "<!--"), 0);
  EXPECT_GT(whole.size(), own.size() + 100000) << "the library is in the page";
  for (const char* mark : {"/*style*/", "/*library*/", "/*script*/", "/*data*/", "src=\"", "http", "url("})
    EXPECT_EQ(count(own, mark), mark == std::string("http") ? 1 : 0) << mark;  // once: "http-equiv"
}

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
  thin.reset();  // from before there were regions
  EXPECT_TRUE(compared(after).changes.empty());
}

TEST(Compare, ALongerHistoryIsAnotherMeasurement) {
  BenchResult other = sample_result();
  other.conditions.history_warm_up = 6;
  const auto refused = compare(sample_result(), other);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.status().message().find("--history-warm-up"), std::string::npos);
  other.conditions.history_warm_up.reset();  // from before there were methods that accumulate
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
