// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "quincunx/device.h"
#include "quincunx/status.h"

namespace quincunx::tools {

// Lines for --explain, as ResolvePlan::explain() words them: the device that a program opened and which profile cuts
// its work, or why there is none.
std::string device_lines(const Result<Device>& device);

}  // namespace quincunx::tools
