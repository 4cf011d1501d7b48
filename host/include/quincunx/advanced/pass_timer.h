// SPDX-License-Identifier: MIT
// PassTimer: the clock that measures the times of a device's passes.
//
// Some drivers give events wrong time stamps. So when a device is opened, a small kernel runs twice, the second time
// with eight times the work, and both runs are compared with the host's clock. Stamps are valid if they are in order,
// span no more than the host's time, and grow with the work. A positive result is kept in cache_folder() for each
// device and driver, so that this takes its milliseconds only once. A negative result is not kept, because other users
// of the device may have caused it.
#pragma once

#include <cstdint>

#include "quincunx/advanced/export.h"
#include "quincunx/device.h"

namespace quincunx {

enum class PassTimer : std::uint8_t {
  kNone,       // none: the queue has no profiling
  kEvents,     // the stamps of OpenCL's events
  kHostClock,  // the host's, if the service may wait for each pass, because stamps are wrong
};

// Returns the clock that was chosen when the device was opened or borrowed. Thread-safe.
QUINCUNX_API PassTimer pass_timer(const Device& device);

QUINCUNX_API const char* name_of(PassTimer timer);  // static: "OpenCL event", "host clock", "not timed"

}  // namespace quincunx
