// SPDX-License-Identifier: MIT
// two_way_pictures(): the measured frames of a case by the histories of frames before and after them. What is to come
// cannot be resolved beside the other methods, so it has frames of its own, drawn forwards and backwards.
#pragma once

#include <vector>

#include "bench/speed_error/bench_plan.h"
#include "frames/frame_source.h"

namespace quincunx::bench {

// Returns the linear pictures of the measured frames, in order, as quincunx-resolve --two-way 8 makes them: RGBA of the
// output's extent. `method` has two_way. Blocks. Errors: of the device.
Result<std::vector<std::vector<float>>> two_way_pictures(const scenes::FrameSource& stage,
                                                         const BenchPlan& plan, double scale,
                                                         const BenchMethod& method);

}  // namespace quincunx::bench
