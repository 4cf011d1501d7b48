// SPDX-License-Identifier: MIT
// PassTimer: the clock that the times of a device's passes come from.
//
// Some drivers stamp events with times that mean nothing. So when a device is opened a small kernel runs twice, the
// second time with eight times the work, and the stamps of both runs are held against the host's clock around them.
// Stamps are believed where they are in order, are no longer than what the host saw, and grow with the work. That
// they are is kept in cache_folder() for each device and driver, so that this costs its milliseconds once. A doubt,
// which may come from others who use the device, is not kept.
#pragma once

#include <cstdint>

#include "quincunx/advanced/export.h"
#include "quincunx/device.h"

namespace quincunx {

enum class PassTimer : std::uint8_t {
  kNone,       // the queue takes no times: they stay unknown
  kEvents,     // the stamps of OpenCL's events
  kHostClock,  // stamps are not believed: the host's clock, where the service may wait for each pass
};

// Settled when the device was opened or borrowed. Thread-safe.
QUINCUNX_API PassTimer pass_timer(const Device& device);

QUINCUNX_API const char* name_of(PassTimer timer);  // static: "OpenCL event", "host clock", "not timed"

}  // namespace quincunx
