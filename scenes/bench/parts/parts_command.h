// SPDX-License-Identifier: MIT
// quincunx-bench --parts: its options, and what it does.
#pragma once

#include <string>

#include "bench/parts/parts_result.h"
#include "quincunx/status.h"

namespace quincunx::tools {
class CommandLine;
}

namespace quincunx::bench {

struct BenchOptions;

struct PartsOptions {
  bool wanted = false;
  double base_scale = 0.71;  // of the picture, where a part's scale is changed
};

// --parts, and options that need it.
void add_parts_options(tools::CommandLine& app, PartsOptions& options);

// Of the first scene and the first method that the options name; by default the courtyard and the default method. The
// picture's own scale goes through those that the options name. Errors: of any part, as that part words them.
Result<PartsResult> run_parts(const BenchOptions& options);

}  // namespace quincunx::bench
