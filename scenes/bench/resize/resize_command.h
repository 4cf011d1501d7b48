// SPDX-License-Identifier: MIT
// quincunx-bench --resize: its options, and what it does.
#pragma once

#include <string>

#include "bench/resize/resize_result.h"
#include "quincunx/status.h"

namespace quincunx::tools {
class CommandLine;
}

namespace quincunx::bench {

struct BenchOptions;

struct ResizeOptions {
  bool wanted = false;
  int resizes = 200;
};

// --resize, and options that need it.
void add_resize_options(tools::CommandLine& app, ResizeOptions& options);

// Of the first scene, the first method and the scales that the options name; by default the courtyard, the default
// method and 0.5, 0.7 and 1. Errors: of any part, as that part words them.
Result<ResizeResult> run_resize(const BenchOptions& options);

}  // namespace quincunx::bench
