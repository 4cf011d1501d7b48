// SPDX-License-Identifier: MIT
// Every controller over every trace, and what a run says: a table to read, JSON and CSV to keep.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/traces/replay.h"

namespace quincunx::traces {

// A controller by name, made new for each replay.
struct ControllerKind {
  std::string name;
  bool ours = false;  // this library's, rather than a stand-in for somebody else's
  std::function<std::unique_ptr<ResolutionController>(const LadderSettings&, const Display&)> make;
};
std::vector<ControllerKind> controller_kinds();

struct NamedTraces {
  std::string name;  // "development", "held-out", "recorded"
  std::function<std::vector<LoadTrace>(std::uint64_t seed)> make;
};
std::vector<NamedTraces> scripted_traces();

struct TraceSettings {
  LadderSettings ladder = {.output_extent = {1920, 1080}};
  std::vector<Display> displays = {Display{}};
  std::vector<std::uint64_t> seeds = {1, 2, 3};
  std::vector<NamedTraces> lists = scripted_traces();
};

// Sums over the feasible traces of a list; means over the seeds.
struct TraceTotals {
  int frames = 0;      // that counted, of one seed
  double dropped = 0;  // frames of one seed
  double pixels = 0;   // mean of the traces' shares of the oracle's
  double changes_per_second = 0;
  double oscillation = 0;
  double settle_up = -1;  // mean of the traces that have steps
  double settle_down = -1;

  double dropped_per_thousand() const { return frames > 0 ? 1000 * dropped / frames : 0; }
};

struct TraceRow {
  std::string trace;
  TraceKind kind = TraceKind::kFeasible;
  ReplayScore score;       // means over the seeds, but for the counts
  double dropped = 0;      // mean over the seeds
  double cpu_dropped = 0;  // the same
};

struct ControllerResult {
  std::string controller;
  bool ours = false;
  std::string list;
  Display display;
  TraceTotals totals = {};
  std::vector<TraceRow> rows = {};
};

struct TraceRun {
  TraceSettings settings;
  std::vector<ControllerResult> results;
};

TraceRun run_traces(const TraceSettings& settings);

std::string text_of(const TraceRun& run);
std::string json_of(const TraceRun& run);
std::string csv_of(const TraceRun& run);  // one line per controller, display and trace

}  // namespace quincunx::traces
