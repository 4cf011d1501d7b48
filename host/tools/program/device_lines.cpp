// SPDX-License-Identifier: MIT
#include "tools/program/device_lines.h"

#include <fmt/format.h>

#include "quincunx/device_profile.h"

namespace quincunx::tools {

std::string device_lines(const Result<Device>& device) {
  if (!device.ok()) return fmt::format("Device         none: {}\n", device.status().message());
  const DeviceInfo& info = device.value().info();
  return fmt::format("Device         {}, {} {}\nProfile        {}\n", info.name, info.platform, info.driver,
                     device.value().profile().describe());
}

}  // namespace quincunx::tools
