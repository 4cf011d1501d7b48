// SPDX-License-Identifier: MIT
#include "tools/program/pacing_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tools/program/run_report.h"

namespace quincunx::tools {
namespace {

// 10 a second: five frames, the third two refreshes late, the last beyond the first second.
PacingRun example() {
  PacingRun run{.controller = "predictive", .measured_by = "made up", .target_fps = 10, .output = {100, 100}};
  run.frames = {
      {.index = 0, .render = {100, 100}, .shown_ms = 0, .busy_ms = 90},
      {.index = 1, .render = {100, 100}, .shown_ms = 100, .busy_ms = 120},
      {.index = 2, .render = {50, 100}, .shown_ms = 400, .busy_ms = 100, .missed = 2},
      {.index = 3, .render = {50, 100}, .shown_ms = 500, .busy_ms = 60},
      {.index = 4, .render = {60, 100}, .shown_ms = 1250, .busy_ms = 80, .missed = 1},
  };
  return run;
}

TEST(PacingReport, TheSummaryIsOfEveryFrame) {
  const PacingSummary summary = summary_of(example());
  EXPECT_DOUBLE_EQ(summary.achieved_fps, 4 / 1.25);
  EXPECT_EQ(summary.dropped, 3);
  EXPECT_EQ(summary.dropped_at_start, 2);
  EXPECT_DOUBLE_EQ(summary.mean_busy_ms, 90);
  EXPECT_EQ(summary.median_busy_ms, 90);
  EXPECT_EQ(summary.p95_busy_ms, 120);
  EXPECT_EQ(summary.over_target, 1) << "exactly the interval is in time";
  EXPECT_DOUBLE_EQ(summary.mean_area, (1 + 1 + 0.5 + 0.5 + 0.6) / 5);
  EXPECT_EQ(summary.least_area, 0.5);
  EXPECT_EQ(summary.largest_area, 1);
  EXPECT_DOUBLE_EQ(summary.changes_per_second, 2 / 1.25);
}

TEST(PacingReport, OneFrameHasNoRate) {
  PacingRun run = example();
  run.frames.resize(1);
  const PacingSummary summary = summary_of(run);
  EXPECT_EQ(summary.achieved_fps, 0);
  EXPECT_EQ(summary.mean_area, 1);
  run.frames.clear();
  EXPECT_EQ(summary_of(run).mean_area, 0);
}

TEST(PacingReport, TextComparesWithTheOthers) {
  PacingRun fixed = example();
  fixed.controller = "fixed 1";
  for (PacedFrame& frame : fixed.frames)
    frame.busy_ms *= 2;
  const std::string text = pacing_text({example(), fixed});
  for (const char* part : {"target 10.00", "predictive", "fixed 1", "2.00x", "made up", "Scale over"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  EXPECT_EQ(pacing_text({}), "");
}

TEST(PacingReport, JsonHasEveryFrameOfEveryRun) {
  RunReport report;
  report.pacing = {example(), example()};
  const auto json = nlohmann::json::parse(to_json(report)).at("pacing");
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0].at("summary").at("dropped"), 3);
  EXPECT_EQ(json[1].at("frames").size(), 5u);
  EXPECT_EQ(json[1].at("frames")[2].at("missed"), 2);
  EXPECT_TRUE(json[1].at("frames")[2].at("cpu_ms").is_null()) << "not known";
}

}  // namespace
}  // namespace quincunx::tools
