// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace quincunx::tools {

// Lines for --explain, as ResolvePlan::explain() words them: the device that a program would open for this selector and
// which profile cuts its work, or why there is none.
std::string device_lines(const std::string& selector);

}  // namespace quincunx::tools
