// SPDX-License-Identifier: MIT
// The cost of targets of another size, by each way to have them.
#pragma once

#include <vector>

#include "bench/resize/resize_result.h"
#include "programs/frame_source.h"
#include "quincunx/status.h"

namespace quincunx::bench {

struct ResizeSettings {
  Extent largest;
  int resizes = 0;  // of each way that count
  std::uint64_t seed = 0;
};

// Host times with nothing else at work: GL is waited for before each resize. The context of `stage` is current.
Result<std::vector<ResizeCost>> measure_resizes(const scenes::FrameSource& stage,
                                                const ResizeSettings& settings);

}  // namespace quincunx::bench
