// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "device/opencl.h"
#include "quincunx/advanced/device_profile.h"
#include "quincunx/advanced/pass_timer.h"
#include "quincunx/device.h"

namespace quincunx {

// The programs that were built in a context, by kernel and options. A driver that keeps its programs still preprocesses
// their source whenever it is handed it, which takes PoCL longer than all else that a service needs to be made.
struct BuiltPrograms {
  std::mutex mutex;
  std::unordered_map<std::string, cl::Program> programs;
};

struct Device::Impl {
  DeviceInfo info;
  cl::Device device;
  cl::Context context;
  cl::CommandQueue queue;
  PassTimer timer = PassTimer::kNone;
  DeviceProfile profile;
  // The driver itself keeps what it compiles from one run to the next, so the program cache leaves kernels to it.
  bool keeps_programs = false;
  std::shared_ptr<BuiltPrograms> built = std::make_shared<BuiltPrograms>();
};

// Returns the position of the device that a selector of Device::open() names: an index where there is such a device, and
// so a number beyond the last index is a part of a name, as any other text.
std::optional<std::size_t> choose_device(const std::string& selector, const std::vector<DeviceInfo>& infos);

}  // namespace quincunx
