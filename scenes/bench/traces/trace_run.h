// SPDX-License-Identifier: MIT
// Every controller over every trace, the quality controller over content traces beside the predictive one with each
// method, and the results: a table to read, JSON and CSV to keep.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/traces/quality_replay.h"
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

struct QualityRunSettings {
  LadderSettings ladder = {.output_extent = {1920, 1080}};
  Display display;
  std::vector<std::uint64_t> seeds = {1, 2, 3};
  std::vector<Split> splits = {Split::kDevelopment, Split::kHeldOut};
  bool times_passes = true;           // else the controller knows whole frames alone
  std::vector<double> budgets = {1};  // multiples of the time that loads and machines are written for
};

// Means over the traces of a split on one machine, and over the seeds; frames and drops are sums over the traces.
struct QualityResult {
  std::string controller;    // "oracle", "quality", "predictive, temporal:fast"
  std::string traces = {};   // "development", "held-out"
  std::string machine = {};  // "strong"
  double budget = 1;
  QualityScore score = {};
  double flip_over_oracle = 0;     // mean of the traces' FLIP over the oracle's
  std::vector<double> flips = {};  // one for each trace, in their order
};

struct QualityRun {
  QualityRunSettings settings;
  std::vector<QualityResult> results;
};

// Runs each split, machine and budget: the oracle first, then quality with a front that was measured there and with the
// one that is built in, predictive with each method, scale 1 with each method.
QualityRun run_quality(const QualityRunSettings& settings);

std::string text_of(const QualityRun& run);
std::string json_of(const QualityRun& run);
std::string csv_of(const QualityRun& run);  // a line for each result

}  // namespace quincunx::traces
