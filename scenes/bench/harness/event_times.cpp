// SPDX-License-Identifier: MIT
#include "bench/harness/event_times.h"

#include <fmt/format.h>

#include "quincunx/pass_timer.h"

namespace quincunx::bench {

Status check_event_times(const Device& device) {
  if (pass_timer(device) == PassTimer::kEvents) return {};
  return Status::unsupported(fmt::format(
      "the benchmark measures by OpenCL events, and those of '{}' do not agree with the host's clock; "
      "choose another device with --device",
      device.info().name));
}

}  // namespace quincunx::bench
