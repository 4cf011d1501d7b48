// SPDX-License-Identifier: MIT
// Which clock times the passes of a device; see quincunx/pass_timer.h.
#pragma once

#include "device_impl.h"

namespace quincunx {

// From the cache, or from a known load on a queue of its own, which takes some tens of milliseconds, and is logged.
// Where the load cannot run at all, the host's clock is the answer, and none is kept. Thread-safe. May throw cl::Error,
// of the device's queue.
PassTimer validated_timer(const Device::Impl& device);

}  // namespace quincunx
