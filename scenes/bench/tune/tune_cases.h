// SPDX-License-Identifier: MIT
// The cases of --tune: methods and options that together run every pass but those that seldom run (clear_region,
// resize_*), and how one is timed.
#pragma once

#include <span>
#include <vector>

#include "bench/tune/tune_choice.h"
#include "bench/tune/tune_stand.h"

namespace quincunx::bench {

std::vector<TuneCase> tune_cases();

// Those of these names, or all where there are none. Errors: kInvalidArgument for another name.
Result<std::vector<TuneCase>> tune_cases(const std::vector<std::string>& names);

// All profiles were used in each round, one after the other, each time another one first, after the copy.
struct CaseTimes {
  Samples copy_ms;
  ShapeTimes shapes;
};

// By the clock that the device's passes have. One thread, that of the GL context. Errors: those of the frames, and of
// the first profile; another profile that the device refuses has no times.
Result<CaseTimes> time_case(const scenes::FrameSource& stage, const TuneCase& what, const TuneEffort& effort,
                            std::span<const DeviceProfile> profiles);

}  // namespace quincunx::bench
