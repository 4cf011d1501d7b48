// SPDX-License-Identifier: MIT
// The machine that a benchmark ran on.
#pragma once

#include <nlohmann/json.hpp>

#include "bench/speed_error/bench_result.h"
#include "frames/frame_source.h"

namespace quincunx::bench {

void describe_machine(const scenes::FrameSource& source, Machine& machine);

// For the tables of --resize and --parts.
nlohmann::ordered_json json_of(const Machine& machine);

double load_of_last_minute();  // processes that ran or wanted to; 0 where it is not known

}  // namespace quincunx::bench
