// SPDX-License-Identifier: MIT
// The clocks of a benchmark.
#pragma once

#include "quincunx/device.h"

namespace quincunx::bench {

// Whether a benchmark may measure this device by its OpenCL events (see quincunx/advanced/pass_timer.h). Errors:
// kUnsupported, naming the device.
Status check_event_times(const Device& device);

// Processor time of this process so far, all threads, ms.
double processor_ms();

}  // namespace quincunx::bench
