// SPDX-License-Identifier: MIT
// PresentPass: present, from the resolved picture to 8-bit sRGB.
#pragma once

#include "pass_common.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

class PresentPass {
 public:
  PresentPass(const Device::Impl& device, const ResolveSettings& settings);

  static constexpr const char* kernel_name() { return "present"; }

  void warm_up(const cl::CommandQueue& queue);  // blocks

  // `exposure` multiplies linear colour; 0 means 1. Writes the whole output extent of `presented`.
  void enqueue(const cl::CommandQueue& queue, const ImageView& resolved, float exposure,
               const ImageView& presented, Counter counter, cl::Event* event);

 private:
  void launch(const cl::CommandQueue& queue, const ImageView& resolved, Extent extent, float exposure,
              const ImageView& presented, Counter counter, cl::Event* event);

  const Device::Impl& device_;
  ResolveSettings settings_;
  cl::Kernel kernel_;
};

}  // namespace quincunx
