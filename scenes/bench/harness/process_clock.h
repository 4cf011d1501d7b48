// SPDX-License-Identifier: MIT
// The clocks of a benchmark's own process.
#pragma once

#include <string>

namespace quincunx::bench {

// Processor time of this process so far, all threads, ms.
double processor_ms();

std::string date_now();  // UTC, "2026-11-21 14:03 UTC"

}  // namespace quincunx::bench
