// SPDX-License-Identifier: MIT
// TuneResult: what quincunx-bench --tune has measured, and the device profile that it chose.
#pragma once

#include <string>
#include <vector>

#include "bench/speed_error/bench_result.h"
#include "quincunx/device_profile.h"

namespace quincunx::bench {

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
