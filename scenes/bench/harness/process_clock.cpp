// SPDX-License-Identifier: MIT
#include "bench/harness/process_clock.h"

#include <time.h>

namespace quincunx::bench {

double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

}  // namespace quincunx::bench
