// SPDX-License-Identifier: MIT
// quincunx-bench --tune: its options, and what it does.
#pragma once

#include <string>
#include <vector>

#include "bench/tune/tune_choice.h"
#include "quincunx/status.h"

namespace quincunx::bench {

struct BenchOptions;

struct TuneOptions {
  bool wanted = false;
  int frames = 8;
  std::vector<std::string> cases;  // empty: all
};

// --tune, and options that need it.
// Chooses a shape for each pass on the device that the options name, and keeps the profile for it; frames are those of
// the first scene, by default the courtyard. Errors: of any part, as that part words them; then no profile is written.
Result<TuneResult> run_tune(const BenchOptions& options);

}  // namespace quincunx::bench
