// SPDX-License-Identifier: MIT
// quincunx-bench --tune: which shapes a pass is tried with, which of them it gets, and what that gains.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/speed_error/bench_result.h"
#include "bench/speed_error/bench_statistics.h"
#include "quincunx/advanced/device_profile.h"

namespace quincunx {

template <typename Io, bench::SameAs<WorkShape> Self>
void fields(Io& io, Self& value) {
  io("group", std::array{value.group_width, value.group_height});
  io("pixels", value.pixels_per_item);
}

}  // namespace quincunx

namespace quincunx::bench {

struct BenchOptions;

struct TuneOptions {
  bool wanted = false;
  int frames = 8;
  std::vector<std::string> cases;  // empty: all
};

// Returns the default, then others with groups of at most `most_items` work-items.
std::vector<WorkShape> shapes_to_try(const WorkShape& plain, std::size_t most_items);

// Milliseconds of each pass, by kernel; one sample a round.
using PassTimes = std::map<std::string, Samples>;

// Times of one case: the same rounds with each shape, in the order of the shapes. A shape that the device refused has
// none.
using ShapeTimes = std::vector<PassTimes>;

// Returns the median of time / time with the default shape in the same round, over all cases; by kernel, for each
// shape. Infinite where a case that runs the pass was refused.
std::map<std::string, std::vector<double>> quotients_of(const std::vector<ShapeTimes>& cases);

// A shape replaces the default only where it gains this much; less is noise.
constexpr double kLeastGain = 0.05;

// Chooses the shape of least quotient for each pass; for passes that no case ran, the one of least geometric mean if it
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
  double default_copies = 0;
  double tuned_copies = 0;
};
QUINCUNX_FIELDS(TunedPass, kernel, shape, default_copies, tuned_copies)

// Whole frames of a method whose images or history are kept in another way, with the profile: medians, in copies.
struct TunedStorage {
  std::string method;
  double buffers_copies = 0;            // and history in halves
  std::optional<double> images_copies;  // the frame's inputs as images; absent where the device has none
  std::optional<double> float_history_copies;  // absent where the method keeps no history
};
QUINCUNX_FIELDS(TunedStorage, method, buffers_copies, images_copies, float_history_copies)

struct TuneResult : RunFacts {
  std::array<int, 2> output{};
  std::string clock;   // "OpenCL event"
  double copy_ms = 0;  // least time of the copy
  double seconds = 0;  // that tuning took
  std::string file;    // where the profile is kept
  WorkShape default_shape;
  DeviceProfile profile;
  std::vector<TunedPass> passes;
  std::vector<TunedStorage> storages;
};
template <typename Io, SameAs<TuneResult> Self>
void fields(Io& io, Self& value) {
  QUINCUNX_EACH_FIELD(version, command, date, output, clock, copy_ms, seconds, machine, file, default_shape)
  io("shape_of_others", value.profile.shape);
  QUINCUNX_EACH_FIELD(passes, storages)
}

std::string text_of(const TuneResult& result);
std::string csv_of(const TuneResult& result);  // the passes

// Chooses a shape for each pass on the device that the options name, and keeps the profile for it; frames are those of
// the first scene, by default the courtyard. Throws a Failure, and then writes no profile.
TuneResult run_tune(const BenchOptions& options);

}  // namespace quincunx::bench
