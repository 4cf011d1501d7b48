// SPDX-License-Identifier: MIT
// The simulated display against frames worked out by hand.
#include <algorithm>
#include <deque>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/traces/load_trace.h"
#include "bench/traces/replay.h"
#include "bench/traces/trace_run.h"

namespace quincunx::traces {
namespace {

// Two rungs' worth of freedom and none used: draws what it is told to.
class FixedController final : public ResolutionController {
 public:
  FixedController()
      : ResolutionController(ResolutionLadder::create({.output_extent = {100, 100}}).value(), 1) {}
  const char* name() const override { return "fixed"; }
  std::vector<FrameTiming> seen;

 private:
  int choose(const FrameTiming& timing) override {
    seen.push_back(timing);
    return ladder().top();
  }
};

constexpr double kRefreshHz = 100;  // 10 ms

LoadTrace trace_of(const std::vector<double>& times, double cpu = 0) {
  LoadTrace trace{.name = "by hand", .frames = {}};
  for (const double time : times)
    trace.frames.push_back({.fixed = time, .cpu = cpu});
  return trace;
}

std::vector<ReplayedFrame> play(const std::vector<double>& times, Display display, double cpu = 0) {
  FixedController controller;
  return replay(trace_of(times, cpu), display, controller);
}

std::vector<int> drops(const std::vector<ReplayedFrame>& frames) {
  std::vector<int> list;
  for (const ReplayedFrame& frame : frames)
    list.push_back(frame.dropped);
  return list;
}

TEST(Replay, ThreeBuffersAbsorbOneSlowFrame) {
  // Quick frames fill the queue; then 1.9 refreshes fit, for the frame before is still to be shown.
  const auto frames = play({0.5, 0.5, 0.5, 0.5, 0.5, 1.9, 0.5, 0.5}, {kRefreshHz, 3, 1});
  EXPECT_EQ(drops(frames), (std::vector<int>{0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(frames[4].queued, 2);
  EXPECT_EQ(frames[5].queued, 1);
  const auto slower = play({0.5, 0.5, 0.5, 0.5, 0.5, 2.1, 0.5, 0.5}, {kRefreshHz, 3, 1});
  EXPECT_EQ(drops(slower), (std::vector<int>{0, 0, 0, 0, 0, 1, 0, 0}));
}

TEST(Replay, TwoBuffersAbsorbNone) {
  const auto frames = play({0.5, 0.5, 0.5, 1.1, 0.5, 0.5}, {kRefreshHz, 2, 1});
  EXPECT_EQ(drops(frames), (std::vector<int>{0, 0, 0, 1, 0, 0}));
}

TEST(Replay, BacklogAddsUp) {
  // From a full queue each frame is .3 late: the fourth no longer fits.
  const auto frames = play({0.5, 0.5, 0.5, 0.5, 1.3, 1.3, 1.3, 1.3}, {kRefreshHz, 3, 1});
  EXPECT_EQ(drops(frames), (std::vector<int>{0, 0, 0, 0, 0, 0, 0, 1}));
}

TEST(Replay, IntervalHoldsTheWaitForABuffer) {
  const auto frames = play({0.5, 0.5, 0.5, 0.5, 0.5, 0.5}, {kRefreshHz, 3, 1});
  EXPECT_DOUBLE_EQ(frames[1].interval_ms, 5);
  EXPECT_DOUBLE_EQ(frames[5].interval_ms, 10);
}

TEST(Replay, DropsForTheProcessorAreToldApart) {
  const auto frames = play(std::vector<double>(20, 0.5), {kRefreshHz, 3, 1}, 1.5);
  int cpu_late = 0;
  for (const ReplayedFrame& frame : frames) {
    EXPECT_TRUE(frame.cpu_late || frame.dropped == 0);
    cpu_late += frame.dropped;
  }
  EXPECT_GT(cpu_late, 5);
}

TEST(Replay, TimersComeBackLate) {
  for (int latency = 1; latency <= 4; ++latency) {
    FixedController controller;
    replay(trace_of(std::vector<double>(10, 0.5)), {kRefreshHz, 3, latency}, controller);
    ASSERT_EQ(controller.seen.size(), static_cast<std::size_t>(10 - latency));
    EXPECT_EQ(controller.seen[2].frame, 2u);
    EXPECT_EQ(controller.seen[2].next_frame, 2u + static_cast<unsigned>(latency));
  }
}

TEST(Replay, OracleIsTheLargestRungThatFits) {
  LoadTrace trace{.name = "by hand",
                  .frames = {{.fixed = 0.2, .scaling = 1.6}, {.fixed = 0.5}, {.fixed = 2}}};
  FixedController controller;
  const auto frames = replay(trace, {kRefreshHz, 3, 1}, controller);
  EXPECT_LE(frames[0].oracle_area, 0.5);
  EXPECT_GT(frames[0].oracle_area, 0.5 - 0.02);  // a rung of this small ladder
  EXPECT_EQ(frames[1].oracle_area, 1);
  EXPECT_EQ(frames[2].oracle_area, 0.25);
}

TEST(Replay, ScoreCountsWhatItSays) {
  LoadTrace trace = trace_of(std::vector<double>(kWarmUp + 100, 0.5));
  trace.steps_up = {kWarmUp + 20};
  std::vector<ReplayedFrame> frames(trace.frames.size(), ReplayedFrame{.area = 0.5, .oracle_area = 1});
  frames[3].dropped = 7;  // warm-up
  frames[kWarmUp + 1].dropped = 2;
  frames[kWarmUp + 2] = {.area = 0.5, .oracle_area = 1, .dropped = 3, .cpu_late = true};
  for (std::size_t frame = kWarmUp + 30; frame < frames.size(); ++frame)
    frames[frame].area = 0.4;
  frames[kWarmUp + 60].area = 0.41;  // up and down again: three changes, two of them against the one before
  const ReplayScore result = score(trace, {kRefreshHz, 3, 1}, frames);
  EXPECT_EQ(result.frames, 100);
  EXPECT_EQ(result.dropped, 2);
  EXPECT_EQ(result.cpu_dropped, 3);
  EXPECT_NEAR(result.pixels_over_oracle, (30 * 0.5 + 69 * 0.4 + 0.41) / 100, 1e-12);
  EXPECT_DOUBLE_EQ(result.changes_per_second, 3);
  EXPECT_DOUBLE_EQ(result.reversals_per_second, 2);
  EXPECT_EQ(result.settle_up_frames, 10);
  EXPECT_EQ(result.settle_down_frames, std::nullopt);
}

TEST(LoadTrace, SameSeedSameTrace) {
  for (const Split split : {Split::kDevelopment, Split::kHeldOut}) {
    const auto first = traces_of(split, 5);
    const auto second = traces_of(split, 5);
    const auto other = traces_of(split, 6);
    ASSERT_EQ(first.size(), 18u);
    for (std::size_t index = 0; index < first.size(); ++index) {
      ASSERT_EQ(first[index].frames.size(), static_cast<std::size_t>(kFrames));
      bool differs = false;
      for (std::size_t frame = 0; frame < first[index].frames.size(); ++frame) {
        ASSERT_EQ(first[index].frames[frame].gpu(0.7), second[index].frames[frame].gpu(0.7));
        differs = differs || first[index].frames[frame].gpu(0.7) != other[index].frames[frame].gpu(0.7);
      }
      EXPECT_TRUE(differs) << first[index].name;
    }
  }
}

// `feasible` promises this: but for single frames, a quarter of the pixels fits.
TEST(LoadTrace, FeasibleTracesAre) {
  for (const Split split : {Split::kDevelopment, Split::kHeldOut}) {
    for (const LoadTrace& trace : traces_of(split, 1)) {
      int run = 0;
      int longest = 0;
      for (const FrameLoad& load : trace.frames) {
        run = load.gpu(0.25) > 1 ? run + 1 : 0;
        longest = std::max(longest, run);
      }
      if (trace.kind == TraceKind::kInfeasible) {
        EXPECT_GE(longest, 100) << trace.name;
      } else {
        EXPECT_LE(longest, 1) << trace.name;
      }
    }
  }
}

TEST(RecordedTrace, ReadsColumnsByName) {
  const Result<LoadTrace> trace = recorded_trace(
      "by hand", "cpu_ms,frame,area_fraction,gpu_ms\r\n3,1,0.5,12.5\r\n4,2,1,20\r\n", {10, 0.25});
  ASSERT_TRUE(trace.ok()) << trace.status().message();
  ASSERT_EQ(trace->frames.size(), 2u);
  EXPECT_DOUBLE_EQ(trace->frames[0].gpu(0.5), 1.25);
  EXPECT_DOUBLE_EQ(trace->frames[0].gpu(1), 2);  // 12.5 / (.25 + .75 / 2) = 20
  EXPECT_DOUBLE_EQ(trace->frames[0].cpu, 0.3);
  EXPECT_DOUBLE_EQ(trace->frames[1].gpu(1), 2);
}

TEST(RecordedTrace, BadTextNamesTheLine) {
  for (const auto& [text, words] : {std::pair{"", "line 1"},
                                    {"gpu_ms\n1\n", "line 1"},
                                    {"gpu_ms,area_fraction\n", "no frames"},
                                    {"gpu_ms,area_fraction\n1,1\n2\n", "line 3"},
                                    {"gpu_ms,area_fraction\n1,1\n-2,1\n", "line 3"},
                                    {"gpu_ms,area_fraction\nnan,1\n", "line 2"},
                                    {"gpu_ms,area_fraction\n1x,1\n", "line 2"}}) {
    const Result<LoadTrace> trace = recorded_trace("file", text, {});
    ASSERT_FALSE(trace.ok()) << text;
    EXPECT_NE(trace.status().message().find(words), std::string::npos) << trace.status().message();
  }
  EXPECT_FALSE(recorded_trace("file", "gpu_ms,area_fraction\n1,1\n", {0, 0.25}).ok());
  EXPECT_FALSE(recorded_trace("file", "gpu_ms,area_fraction\n1,1\n", {16, 1}).ok());
}

}  // namespace

// The promises of the default controller on the simulated display, where nothing depends on the machine.

namespace {

const TraceRun& headline() {
  static const TraceRun run = run_traces({});
  return run;
}

const ControllerResult& result_of(const std::string& controller, const std::string& list) {
  for (const ControllerResult& result : headline().results) {
    if (result.controller == controller && result.traces == list) return result;
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
  const ReplayScore& totals = result_of("predictive", GetParam()).totals;
  EXPECT_LE(totals.dropped_per_thousand(), 0.1);
  EXPECT_GE(totals.pixels_over_oracle, 0.96);
  EXPECT_LE(totals.settle_up_frames, 10);  // load up, resolution down
  EXPECT_LE(totals.settle_down_frames, 5);
}

TEST_P(Lists, PredictiveDrawsMorePixelsThanAnyOtherWithFewDrops) {
  const ReplayScore& ours = result_of("predictive", GetParam()).totals;
  for (const ControllerResult& other : headline().results) {
    if (other.traces != GetParam() || other.controller == "predictive") continue;
    EXPECT_GT(ours.pixels_over_oracle, other.totals.pixels_over_oracle) << other.controller;
    EXPECT_LE(ours.dropped, std::max(1.0, other.totals.dropped)) << other.controller;
  }
}

INSTANTIATE_TEST_SUITE_P(Both, Lists, ::testing::Values("development", "held-out"), [](const auto& list) {
  return list.param == "held-out" ? "HeldOut" : "Development";
});

TEST(TraceRun, SingleTracesKeepTheirTargets) {
  const ControllerResult& ours = result_of("predictive", "development");
  EXPECT_LE(row_of(ours, "step up 100 %").score.dropped, 2);
  EXPECT_LE(row_of(ours, "constant").score.changes_per_second, 0.11);  // 1 in 10 s, and the first one
  EXPECT_LE(row_of(ours, "noise 5 %").score.changes_per_second, 2);
  // As many as at the lowest resolution throughout: what cannot be avoided.
  EXPECT_LE(row_of(ours, "infeasible").score.dropped, 250);
  EXPECT_GE(row_of(ours, "infeasible").score.pixels_over_oracle, 0.96);
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
    EXPECT_GT(result.totals.pixels_over_oracle, 0.4) << result.controller;
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
