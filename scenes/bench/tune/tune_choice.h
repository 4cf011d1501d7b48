// SPDX-License-Identifier: MIT
// Which shapes a pass is tried with, and which of them it gets. Pure.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bench/speed_error/bench_statistics.h"
#include "quincunx/device_profile.h"

namespace quincunx::bench {

// The default first, then others with groups of at most `most_items` work-items.
std::vector<WorkShape> shapes_to_try(const WorkShape& plain, std::size_t most_items);

// Milliseconds of each pass, by kernel; one sample a round.
using PassTimes = std::map<std::string, Samples>;

// Of one case: the same rounds with each shape, in the order of the shapes. A shape that the device refused has none.
using ShapeTimes = std::vector<PassTimes>;

// Median of time / time with the default shape in the same round, over all cases; by kernel, for each shape. Infinite
// where a case that runs the pass was refused.
std::map<std::string, std::vector<double>> quotients_of(const std::vector<ShapeTimes>& cases);

// A shape replaces the default only where it gains this much; less is noise.
constexpr double kLeastGain = 0.05;

// The shape of least quotient for each pass; for passes that no case ran, that of the least geometric mean, where it
// gains enough.
DeviceProfile choose_profile(const std::vector<WorkShape>& shapes,
                             const std::map<std::string, std::vector<double>>& quotients);

// Gives each pass its default shape back that has not gained enough when it was measured again; `again`: cases of two
// shapes, the default and the profile's.
void keep_what_gains(DeviceProfile& profile, const WorkShape& plain, const std::vector<ShapeTimes>& again);

}  // namespace quincunx::bench
