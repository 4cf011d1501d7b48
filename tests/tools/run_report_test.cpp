// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tools/program/pacing_report.h"
#include "tools/program/run_report.h"

namespace quincunx::tools {
namespace {

RunReport example(int frames) {
  RunReport report;
  report.program = "quincunx-render";
  report.version = "0.1.0";
  report.command_line = "quincunx-render --frames 240";
  report.scene = "courtyard";
  report.scene_summary = "a courtyard at dusk";
  report.seed = 18446744073709551615U;
  report.output = {1280, 720};
  report.target = {1280, 720};
  report.method = "quincunx";
  report.settings = {{"scale path", "sweep"}, {"jitter", "on"}};
  report.gl = {"surfaceless", "Mesa", "llvmpipe", "4.5"};
  report.cl = {"PoCL", "cpu", "3.1", "OpenCL 3.0", 2};
  report.interop = "copy";
  report.interop_reason = "the device has no cl_khr_gl_sharing";
  const double samples[] = {3, 1, 2, 4};
  const std::uint64_t bytes[] = {10000000, 20000000, 30000000};
  report.passes = {statistics_of("resolve_quincunx", "OpenCL event", samples, bytes)};
  report.left_out = {{"velocity target", "nothing moves"}};
  report.warnings = {
      "no jitter is known (--jitter): to temporal:balanced all frames have their samples at the same places, "
      "and "
      "together they tell little more than one"};
  for (int i = 0; i < frames; ++i) {
    FrameRow row;
    row.index = i;
    row.render = {640 + 2 * i, 360 + i};
    row.ratio = {static_cast<float>(row.render.width) / 1280.0f,
                 static_cast<float>(row.render.height) / 720.0f};
    report.frames.push_back(row);
  }
  report.wall_seconds = 10;
  return report;
}

TEST(PassStatistics, OrderStatisticsAreExact) {
  std::vector<double> samples;
  for (int i = 100; i >= 1; --i)
    samples.push_back(i);
  const PassStatistics even = statistics_of("a", "clock", samples);
  EXPECT_EQ(even.count, 100);
  EXPECT_EQ(even.median_ms, 50.5);
  EXPECT_EQ(even.p95_ms, 95);
  EXPECT_EQ(even.min_ms, 1);
  samples.pop_back();  // 2 to 100
  EXPECT_EQ(statistics_of("a", "clock", samples).median_ms, 51);
  EXPECT_EQ(statistics_of("a", "clock", std::vector<double>{7}).p95_ms, 7);
}

TEST(PassStatistics, UnknownSamplesDoNotCount) {
  const double samples[] = {-1, std::nan(""), 5, std::numeric_limits<double>::infinity()};
  const PassStatistics one = statistics_of("a", "clock", samples);
  EXPECT_EQ(one.count, 1);
  EXPECT_EQ(one.median_ms, 5);
  const PassStatistics none = statistics_of("a", "clock", {});
  EXPECT_EQ(none.count, 0);
  EXPECT_LT(none.median_ms, 0);
  EXPECT_LT(none.bytes, 0);
}

FrameReport two_passes(std::uint64_t frame, double resolve_ms, double present_ms) {
  FrameReport report;
  report.frame_index = frame;
  report.passes.push_back({.kernel = "resolve_quincunx", .ms = resolve_ms, .bytes = 100});
  report.passes.push_back({.kernel = "present", .ms = present_ms, .bytes = 50});
  return report;
}

MeasuredFrames measured(std::initializer_list<FrameReport> reports) {
  MeasuredFrames frames;
  for (const FrameReport& report : reports)
    frames.add(report);
  return frames;
}

TEST(PassStatistics, NamesTheClock) {
  const MeasuredFrames frames = measured({two_passes(0, 2, -1), two_passes(1, 4, -1)});
  for (const PassTimer timer : {PassTimer::kEvents, PassTimer::kHostClock}) {
    const std::vector<PassStatistics> rows = frames.passes(timer);
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].clock, name_of(timer));
    EXPECT_EQ(rows[0].median_ms, 3);
    EXPECT_EQ(rows[1].clock, "not timed") << "no time of it is known";
    EXPECT_EQ(rows[1].count, 0);
    EXPECT_EQ(rows[1].bytes, 50);
  }
  EXPECT_STREQ(name_of(PassTimer::kEvents), "OpenCL event");
  EXPECT_STREQ(name_of(PassTimer::kHostClock), "host clock");
}

TEST(PassStatistics, AFrameWithAnUnknownPassHasNoTime) {
  FrameRow rows[3];
  for (int i = 0; i < 3; ++i)
    rows[i].index = i;
  measured({two_passes(0, 2, 1), two_passes(1, 2, -1), two_passes(2, -1, -1)}).fill(rows);
  EXPECT_EQ(rows[0].device_ms, 3);
  EXPECT_EQ(rows[1].device_ms, -1);
  EXPECT_EQ(rows[2].device_ms, -1);
}

// A frame that is resolved both ways is reported forwards, backwards and when it is shown.
TEST(PassStatistics, TheFirstReportOfAFrameCounts) {
  FrameRow rows[2];
  rows[1].index = 1;
  measured({two_passes(0, 2, 1), two_passes(1, 4, 1), two_passes(1, 8, 1), two_passes(0, 16, 1)}).fill(rows);
  EXPECT_EQ(rows[0].device_ms, 3);
  EXPECT_EQ(rows[1].device_ms, 5);
}

TEST(PassStatistics, ALongRunKeepsAsManySamplesAsAMedianNeeds) {
  Samples samples;
  for (int i = 0; i <= 100'000; ++i)
    samples.add(i, static_cast<std::uint64_t>(i));
  const PassStatistics kept = samples.statistics("a", "clock");
  EXPECT_GT(kept.count, 4'000);
  EXPECT_LE(kept.count, 8'192);
  EXPECT_NEAR(kept.median_ms, 50'000, 16);  // they are 16 apart
  EXPECT_NEAR(kept.p95_ms, 95'000, 16);
  EXPECT_NEAR(static_cast<double>(kept.bytes), 50'000, 16);
  EXPECT_EQ(samples.total_ms(), 100'000. * 100'001 / 2);
  Samples without_bytes;
  without_bytes.add(1);
  EXPECT_EQ(without_bytes.statistics("a", "clock").bytes, -1);
}

TEST(RunReport, JsonHoldsEveryFrame) {
  const auto json = nlohmann::json::parse(to_json(example(240)));
  EXPECT_EQ(json["frames"].size(), 240U);
  EXPECT_EQ(json["frames"][239]["render"], (nlohmann::json{1118, 599}));
  EXPECT_TRUE(json["frames"][0]["frame_ms"].is_null());
  EXPECT_EQ(json["seed"].get<std::uint64_t>(), 18446744073709551615U);
  EXPECT_EQ(json["passes"][0]["median_ms"], 2.5);
  EXPECT_EQ(json["passes"][0]["bytes"], 20000000);
  EXPECT_EQ(json["settings"]["jitter"], "on");
  EXPECT_EQ(json["left_out"][0]["why"], "nothing moves");
  EXPECT_EQ(json["warnings"][0].get<std::string>().rfind("no jitter is known", 0), 0u);
  EXPECT_EQ(json["cl"]["compute_units"], 2);
}

TEST(RunReport, JsonOfAnEmptyReportIsValid) {
  const auto json = nlohmann::json::parse(to_json({}));
  EXPECT_TRUE(json["interop"].is_null());
  EXPECT_TRUE(json["frames"].is_array());
  EXPECT_TRUE(json["left_out"].is_array());
}

TEST(RunReport, JsonSurvivesBadText) {
  RunReport report = example(1);
  report.command_line = "quincunx-render --scene \"\xff\xfe\".gltf";
  EXPECT_TRUE(nlohmann::json::accept(to_json(report)));
}

TEST(RunReport, TextIsOnePageWhateverTheLength) {
  for (const int frames : {0, 1, 5, 240, 100000}) {
    const std::string text = to_text(example(frames));
    EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 60) << frames;
    EXPECT_NE(text.find("llvmpipe"), std::string::npos);
    EXPECT_NE(text.find("the device has no cl_khr_gl_sharing"), std::string::npos);
    EXPECT_NE(text.find("resolve_quincunx"), std::string::npos);
    EXPECT_NE(text.find("nothing moves"), std::string::npos);
  }
}

TEST(RunReport, TextShowsFirstAndLastFrame) {
  const std::string text = to_text(example(240));
  EXPECT_NE(text.find("640x360"), std::string::npos);
  EXPECT_NE(text.find("1118x599"), std::string::npos);
}

TEST(RatioGraph, DrawsARampAndALevel) {
  std::vector<double> ramp;
  for (int i = 0; i < 8; ++i)
    ramp.push_back(0.3 + 0.1 * i);
  const std::string graph = ratio_graph(ramp);
  EXPECT_EQ(graph.substr(0, graph.find('\n')), "  1.000 |       *");
  EXPECT_NE(graph.find("  0.300 |*\n"), std::string::npos);
  EXPECT_EQ(ratio_graph(std::vector<double>(3, 0.71)), "  0.710 |***\n        +---\n");
  EXPECT_EQ(ratio_graph({}), "");
}

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
