// SPDX-License-Identifier: MIT
// quincunx-bench --traces: its options, and what it does.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/traces/load_trace.h"
#include "bench/traces/trace_run.h"
#include "quincunx/status.h"

namespace quincunx::traces {

struct TraceOptions {
  bool wanted = false;
  std::vector<double> refresh_hz = {60};
  std::vector<int> buffers = {3};
  std::vector<int> latencies = {1};
  bool every_display = false;
  std::vector<std::uint64_t> seeds = {1, 2, 3};
  std::vector<std::string> recorded;  // CSV files
  Recording recording;
  bool quality = false;  // methods are chosen, too
  std::vector<double> budgets = {1};
  bool untimed = false;
};

// Replays everything. Errors: a recording that cannot be read.
Result<TraceRun> run_traces(const TraceOptions& options);

// Replays the quality controller instead, on the first of the displays.
Result<QualityRun> run_quality(const TraceOptions& options);

// Returns a run as one HTML page: tables that sort, and load, resolution and dropped frames over time. `command`: as
// typed. The curves are those of the first display and seed, replayed for the page.
std::string page_of(const TraceRun& run, const std::string& command);

}  // namespace quincunx::traces
