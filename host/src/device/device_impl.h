// SPDX-License-Identifier: MIT
#pragma once

#include "device/opencl.h"
#include "quincunx/device.h"
#include "quincunx/device_profile.h"
#include "quincunx/pass_timer.h"

namespace quincunx {

struct Device::Impl {
  DeviceInfo info;
  cl::Device device;
  cl::Context context;
  cl::CommandQueue queue;
  PassTimer timer = PassTimer::kNone;
  DeviceProfile profile;
  // The driver itself keeps what it compiles from one run to the next, so the program cache leaves kernels to it.
  bool keeps_programs = false;
};

}  // namespace quincunx
