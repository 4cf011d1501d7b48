// SPDX-License-Identifier: MIT
// ClearPass: clear_region, one value into the top left rectangle of an image.
#pragma once

#include "pass_common.h"

namespace quincunx {

// One texel of `format` holding value[0..3] (red, green, blue, alpha), as a buffer holds it: halves rounded
// to nearest even, unorm clamped to [0, 1] and rounded to nearest. Pure.
void encode_texel(PixelFormat format, const float value[4], unsigned bits[4]);

class ClearPass {
 public:
  // One kernel serves all formats of one texel size.
  ClearPass(const Device::Impl& device, Storage storage, PixelFormat format);

  static constexpr const char* kernel_name() { return "clear_region"; }

  void warm_up(const cl::CommandQueue& queue);  // blocks

  // `image` has the pass's storage and a format of the same texel size; `render` lies inside it.
  void enqueue(const cl::CommandQueue& queue, const ImageView& image, Extent render, const float value[4],
               cl::Event* event);

 private:
  const Device::Impl& device_;
  Storage storage_;
  PixelFormat format_;
  cl::Kernel kernel_;
};

}  // namespace quincunx
