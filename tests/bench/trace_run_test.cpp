// SPDX-License-Identifier: MIT
// What the default controller promises on the simulated display, where nothing depends on the machine.
#include "bench/traces/trace_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace quincunx::traces {
namespace {

const TraceRun& headline() {
  static const TraceRun run = run_traces({});
  return run;
}

const ControllerResult& result_of(const std::string& controller, const std::string& list) {
  for (const ControllerResult& result : headline().results) {
    if (result.controller == controller && result.list == list) return result;
  }
  throw std::out_of_range(controller);
}

const TraceRow& row_of(const ControllerResult& result, const std::string& trace) {
  const auto at = std::find_if(result.rows.begin(), result.rows.end(),
                               [&trace](const TraceRow& row) { return row.trace == trace; });
  if (at == result.rows.end()) throw std::out_of_range(trace);
  return *at;
}

class Lists : public ::testing::TestWithParam<std::string> {};

TEST_P(Lists, PredictiveKeepsItsTargets) {
  const TraceTotals& totals = result_of("predictive", GetParam()).totals;
  EXPECT_LE(totals.dropped_per_thousand(), 0.1);
  EXPECT_GE(totals.pixels, 0.96);
  EXPECT_LE(totals.settle_up, 10);  // load up, resolution down
  EXPECT_LE(totals.settle_down, 5);
}

TEST_P(Lists, PredictiveDrawsMorePixelsThanAnyOtherWithFewDrops) {
  const TraceTotals& ours = result_of("predictive", GetParam()).totals;
  for (const ControllerResult& other : headline().results) {
    if (other.list != GetParam() || other.controller == "predictive") continue;
    EXPECT_GT(ours.pixels, other.totals.pixels) << other.controller;
    EXPECT_LE(ours.dropped, std::max(1.0, other.totals.dropped)) << other.controller;
  }
}

INSTANTIATE_TEST_SUITE_P(Both, Lists, ::testing::Values("development", "held-out"), [](const auto& list) {
  return list.param == "held-out" ? "HeldOut" : "Development";
});

TEST(TraceRun, SingleTracesKeepTheirTargets) {
  const ControllerResult& ours = result_of("predictive", "development");
  EXPECT_LE(row_of(ours, "step up 100 %").dropped, 2);
  EXPECT_LE(row_of(ours, "constant").score.changes_per_second, 0.11);  // 1 in 10 s, and the first one
  EXPECT_LE(row_of(ours, "noise 5 %").score.changes_per_second, 2);
  // As many as at the lowest resolution throughout: what cannot be avoided.
  EXPECT_LE(row_of(ours, "infeasible").dropped, 250);
  EXPECT_GE(row_of(ours, "infeasible").score.pixels, 0.96);
}

TEST(TraceRun, EveryDisplayIsReplayed) {
  TraceSettings settings{.displays = {}, .seeds = {1}};
  for (const double hz : {30.0, 60.0, 120.0}) {
    for (const int buffers : {2, 3}) {
      for (const int latency : {1, 2, 3, 4})
        settings.displays.push_back({hz, buffers, latency});
    }
  }
  settings.lists = {{"short", [](std::uint64_t seed) {
                       std::vector<LoadTrace> traces = development_traces(seed);
                       traces.resize(4);
                       return traces;
                     }}};
  const TraceRun run = run_traces(settings);
  ASSERT_EQ(run.results.size(), 24 * controller_kinds().size());
  for (const ControllerResult& result : run.results) {
    EXPECT_GT(result.totals.pixels, 0.4) << result.controller;
    EXPECT_EQ(result.totals.frames, 4 * (kFrames - kWarmUp));
  }
}

TEST(TraceRun, TwoRunsAgree) {
  TraceSettings settings{.seeds = {2}};
  EXPECT_EQ(json_of(run_traces(settings)), json_of(run_traces(settings)));
}

TEST(TraceRun, ReportsHoldTheFigures) {
  const nlohmann::json json = nlohmann::json::parse(json_of(headline()));
  ASSERT_EQ(json["results"].size(), headline().results.size());
  EXPECT_EQ(json["results"][0]["controller"], "predictive");
  EXPECT_EQ(json["results"][0]["dropped"], headline().results[0].totals.dropped);
  EXPECT_EQ(json["results"][0]["rows"][2]["trace"], "step up 30 %");
  EXPECT_TRUE(json["results"][0]["rows"][0]["settle_up_frames"].is_null());
  const std::string csv = csv_of(headline());
  const auto lines = std::count(csv.begin(), csv.end(), '\n');
  EXPECT_EQ(lines, 1 + 18 * static_cast<long>(headline().results.size()));
  EXPECT_NE(text_of(headline()).find("Unity-like"), std::string::npos);
}

}  // namespace
}  // namespace quincunx::traces
