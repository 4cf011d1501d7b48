// SPDX-License-Identifier: MIT
#include "bench/harness/process_clock.h"

#include <fmt/chrono.h>
#include <time.h>

#include <ctime>

namespace quincunx::bench {

double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

std::string date_now() {
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
}

}  // namespace quincunx::bench
