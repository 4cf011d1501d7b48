// SPDX-License-Identifier: MIT
// The choice of the clock that times the passes of a device; see quincunx/advanced/pass_timer.h.
#pragma once

#include <cstdint>
#include <string>

#include "device/device_impl.h"

namespace quincunx {

// Returns the clock from the cache, or from a known load on a queue of its own, which takes some tens of milliseconds,
// and is logged. Where the load cannot run at all, the host's clock is the answer, and none is kept. Thread-safe. May
// throw cl::Error, of the device's queue.
PassTimer validated_timer(const Device::Impl& device);

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

// Returns why the stamps of a light and a heavy run are not believed, as a clause ("they last 0 ms"); empty where they
// are. Host times may be too long, as on a busy machine, so a doubt is certain only when it comes again. Pure.
std::string doubt_about(const TimedLoad& light, const TimedLoad& heavy);

}  // namespace quincunx
