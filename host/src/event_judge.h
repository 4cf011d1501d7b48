// SPDX-License-Identifier: MIT
// Whether the stamps of OpenCL's events are to be believed. Pure.
#pragma once

#include <cstdint>
#include <string>

namespace quincunx {

// CL_PROFILING_COMMAND_SUBMIT, _START and _END of one event: nanoseconds of the device's own clock.
struct EventStamps {
  std::uint64_t submitted = 0;
  std::uint64_t started = 0;
  std::uint64_t ended = 0;
};

// One run of a known kernel. `host_ms`: from before it was enqueued until it was known to be done.
struct TimedLoad {
  EventStamps stamps;
  double host_ms = 0;
};

inline constexpr int kHeavyLoad = 8;  // times the work of the light one

// Why the stamps of a light and a heavy run are not believed, as a clause ("they last 0 ms"); empty where they are.
// Host times may be too long, as on a busy machine, so a doubt is certain only when it comes again.
std::string doubt_about(const TimedLoad& light, const TimedLoad& heavy);

}  // namespace quincunx
