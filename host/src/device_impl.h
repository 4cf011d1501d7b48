// SPDX-License-Identifier: MIT
#pragma once

#include "opencl.h"
#include "quincunx/device.h"

namespace quincunx {

struct Device::Impl {
  DeviceInfo info;
  cl::Device device;
  cl::Context context;
  cl::CommandQueue queue;
};

}  // namespace quincunx
