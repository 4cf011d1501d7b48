// SPDX-License-Identifier: MIT
// Pass statistics: from the service's report of each frame to the rows of a run's report. Pure.
#pragma once

#include <span>
#include <vector>

#include "quincunx/frame.h"
#include "quincunx/pass_timer.h"
#include "tools/program/run_report.h"

namespace quincunx::tools {

// Per kernel, in the order of first use, timed by `timer`. A kernel of which no time is known is "not timed".
std::vector<PassStatistics> pass_statistics(std::span<const FrameReport> reports, PassTimer timer);

// Fills in what the service measured; a frame has an OpenCL time where all its passes have one. Both are in
// frame order; rows without a report stay as they are.
void add_measured(std::span<FrameRow> rows, std::span<const FrameReport> reports);

}  // namespace quincunx::tools
