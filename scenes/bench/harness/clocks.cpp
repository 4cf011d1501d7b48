// SPDX-License-Identifier: MIT
#include "bench/harness/clocks.h"

#include <fmt/format.h>
#include <time.h>

#include "quincunx/advanced/pass_timer.h"

namespace quincunx::bench {

Status check_event_times(const Device& device) {
  if (pass_timer(device) == PassTimer::kEvents) return {};
  return Status::unsupported(fmt::format(
      "the benchmark measures by OpenCL events, and those of '{}' do not agree with the host's clock; "
      "choose another device with --device",
      device.info().name));
}

double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

}  // namespace quincunx::bench
