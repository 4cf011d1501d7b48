// SPDX-License-Identifier: MIT
// A comparison of two results: changes for better or worse beyond noise. Pure.
#pragma once

#include <string>
#include <vector>

#include "bench/speed_error/bench_result.h"
#include "quincunx/status.h"

namespace quincunx::bench {

enum class Verdict { kSame, kBetter, kWorse };

struct Change {
  std::string scene;  // "all": a mean over scenes and scales
  double scale = 1;   // 0 there
  std::string method;
  std::string measure;  // "FLIP", "cost, copies"
  double before = 0;
  double after = 0;
  Verdict verdict = Verdict::kSame;
};

struct Comparison {
  std::vector<Change> changes;       // better and worse, the worse first
  int same = 0;                      // figures within noise
  double cost_deviation = 0;         // standard deviation of a row's cost between the two runs, as part of it
  std::vector<std::string> missing;  // "scene, scale, method" that only the old result has
  std::vector<std::string> added;    // that only the new one has
  std::vector<std::string> notes;    // what could not be compared, and why

  bool worse() const;
};

// Errors are the same in every run on one device and driver, so any change counts that a reader would
// (docs/bench.md lists how much). Cost, in copies, counts where it changed by more than 3 % and four standard
// deviations: of a row (the larger of what its rounds and all rows' changes tell, and the 95 % intervals lie
// apart), and of each method's mean over its rows. It is not compared across machines. Errors:
// kInvalidArgument where the conditions differ in what decides the figures (output, frames, seed, times,
// truth).
Result<Comparison> compare(const BenchResult& before, const BenchResult& after);

std::string text_of(const Comparison& comparison);

}  // namespace quincunx::bench
