// SPDX-License-Identifier: MIT
// A run as one HTML page: tables that sort, and load, resolution and dropped frames over time.
#pragma once

#include <string>

#include "bench/traces/trace_run.h"

namespace quincunx::traces {

// `command`: as typed. The curves are those of the first display and seed, replayed for the page. Pure.
std::string page_of(const TraceRun& run, const std::string& command);

}  // namespace quincunx::traces
