// SPDX-License-Identifier: MIT
// A load recorded from a real program, as a trace.
#pragma once

#include <string>

#include "bench/traces/load_trace.h"
#include "quincunx/status.h"

namespace quincunx::traces {

struct Recording {
  double target_ms = 1000.0 / 60;  // what the recorded times are divided by
  double fixed_part = 0.25;        // of the cost at the output resolution that does not scale, in [0, 0.9]
};

// CSV text: a header line that names at least `gpu_ms` and `area_fraction`, in any order and among others,
// then a line for each frame; `cpu_ms` is read where it is there. No quotes. Errors: kInvalidArgument naming
// the line.
Result<LoadTrace> recorded_trace(const std::string& name, const std::string& csv, const Recording& recording);

}  // namespace quincunx::traces
