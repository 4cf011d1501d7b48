// SPDX-License-Identifier: MIT
#pragma once

#include "quincunx/device.h"

namespace quincunx::bench {

// Whether a benchmark may measure this device by its OpenCL events (see quincunx/pass_timer.h). Errors: kUnsupported,
// naming the device.
Status check_event_times(const Device& device);

}  // namespace quincunx::bench
