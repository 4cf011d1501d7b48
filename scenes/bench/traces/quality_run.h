// SPDX-License-Identifier: MIT
// The quality controller over every content trace, beside the predictive one with each method, and what comes out.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/traces/quality_replay.h"

namespace quincunx::traces {

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
