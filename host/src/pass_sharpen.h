// SPDX-License-Identifier: MIT
// SharpenPass: sharpen, from the resolved picture to a crisper one.
#pragma once

#include "pass_common.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

class SharpenPass {
 public:
  SharpenPass(const Device::Impl& device, const ResolveSettings& settings);

  static constexpr const char* kernel_name() { return "sharpen"; }

  void warm_up(const cl::CommandQueue& queue);  // blocks

  // Reads the whole output extent of `source` and writes that of `sharpened`, which is other memory of the
  // same format.
  void enqueue(const cl::CommandQueue& queue, const ImageView& source, const ImageView& sharpened,
               cl::Event* event);

 private:
  void launch(const cl::CommandQueue& queue, const ImageView& source, Extent extent,
              const ImageView& sharpened, cl::Event* event);

  const Device::Impl& device_;
  ResolveSettings settings_;
  cl::Kernel kernel_;
};

}  // namespace quincunx
