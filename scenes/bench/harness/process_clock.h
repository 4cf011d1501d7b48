// SPDX-License-Identifier: MIT
// The clock of a benchmark's own process.
#pragma once

namespace quincunx::bench {

// Processor time of this process so far, all threads, ms.
double processor_ms();

}  // namespace quincunx::bench
