// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace quincunx::tools {

std::string date_now();  // UTC, "2026-11-21 14:03 UTC"

}  // namespace quincunx::tools
