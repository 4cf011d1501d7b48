// SPDX-License-Identifier: MIT
// What it costs that a frame's inputs are images, not buffers, and that history is kept in floats, not in halves.
#pragma once

#include <vector>

#include "bench/tune/tune_result.h"
#include "bench/tune/tune_stand.h"

namespace quincunx::bench {

// Of those cases that are a method and nothing else, with the profile. One thread, that of the GL context. Errors:
// those of the frames and the device.
Result<std::vector<TunedStorage>> time_storages(const scenes::FrameSource& stage,
                                                const std::vector<TuneCase>& cases, const TuneEffort& effort,
                                                const DeviceProfile& profile);

}  // namespace quincunx::bench
