// SPDX-License-Identifier: MIT
// Every controller over every trace, and what a run says: a table to read, JSON and CSV to keep.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/traces/controllers.h"
#include "bench/traces/replay.h"

namespace quincunx::traces {

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

struct TraceRow {
  std::string trace;
  TraceKind kind = TraceKind::kFeasible;
  ReplayScore score;  // means over the seeds
};

struct ControllerResult {
  std::string controller;
  bool ours = false;
  std::string traces;  // name of the list
  Display display;
  ReplayScore totals = {};  // over the feasible traces: frames and drops are sums, all else means
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
