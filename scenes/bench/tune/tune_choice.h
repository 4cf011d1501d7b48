// SPDX-License-Identifier: MIT
// The choices of quincunx-bench --tune: which shapes a pass is tried with, and which of them it gets. Pure.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bench/speed_error/bench_result.h"
#include "bench/speed_error/bench_statistics.h"
#include "quincunx/advanced/device_profile.h"

namespace quincunx::bench {

// The default first, then others with groups of at most `most_items` work-items.
std::vector<WorkShape> shapes_to_try(const WorkShape& plain, std::size_t most_items);

// Milliseconds of each pass, by kernel; one sample a round.
using PassTimes = std::map<std::string, Samples>;

// Times of one case: the same rounds with each shape, in the order of the shapes. A shape that the device refused has
// none.
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

// A pass with the default shape and with the one that the profile has for it. Both are least times of the same frames,
// in float4 copies of the output.
struct TunedPass {
  std::string kernel;
  WorkShape shape;
  double before = 0;
  double after = 0;
};

// Whole frames of a method whose images or history are kept in another way, with the profile: medians, in copies.
struct TunedStorage {
  std::string method;
  double buffers = 0;        // and history in halves
  double images = 0;         // the frame's inputs as images; 0: the device has none
  double float_history = 0;  // 0: the method keeps no history
};

struct TuneResult {
  std::string version, command, date;
  Extent output;
  std::string clock;   // "OpenCL event"
  double copy_ms = 0;  // least time of the copy
  double seconds = 0;  // that tuning took
  Machine machine;
  WorkShape default_shape;
  DeviceProfile profile;
  std::string file;  // where it is kept
  std::vector<TunedPass> passes;
  std::vector<TunedStorage> storages;
};

std::string text_of(const WorkShape& shape);  // "16x8 items of 4 pixels"
std::string text_of(const TuneResult& result);
std::string json_of(const TuneResult& result);
std::string csv_of(const TuneResult& result);  // the passes

}  // namespace quincunx::bench
