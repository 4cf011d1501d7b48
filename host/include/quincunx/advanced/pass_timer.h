// SPDX-License-Identifier: MIT
// PassTimer: the clock that the times of a device's passes come from.
//
// Some drivers stamp events with wrong times. So when a device is opened a small kernel runs twice, the second time
// with eight times the work, and both runs are compared with the host's clock. Stamps are used where they are in order,
// span no more than the host's time, and grow with the work. A positive result is kept in cache_folder() for each
// device and driver, so that this costs its milliseconds once. A negative one, which other users of the device may
// cause, is not.
#pragma once

#include <cstdint>

#include "quincunx/advanced/export.h"
#include "quincunx/device.h"

namespace quincunx {

enum class PassTimer : std::uint8_t {
  kNone,       // none: the queue takes no times
  kEvents,     // the stamps of OpenCL's events
  kHostClock,  // the host's, where the service may wait for each pass, because stamps are wrong
};

// Returns the clock that was chosen when the device was opened or borrowed. Thread-safe.
QUINCUNX_API PassTimer pass_timer(const Device& device);

QUINCUNX_API const char* name_of(PassTimer timer);  // static: "OpenCL event", "host clock", "not timed"

}  // namespace quincunx
