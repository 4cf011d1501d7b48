// SPDX-License-Identifier: MIT
// clear_region: one value into the top left rectangle of an image.
#pragma once

#include "passes/pass.h"

namespace quincunx {

// One texel of `format` holding value[0..3] (red, green, blue, alpha), as a buffer holds it: halves rounded
// to nearest even, unorm clamped to [0, 1] and rounded to nearest. Pure.
void encode_texel(PixelFormat format, const float value[4], unsigned bits[4]);

// Returns in `stored` the value to write to an image so that it holds the nearest one: OpenCL lets write_imagef round
// halves towards zero. Pure.
void stored_value(PixelFormat format, const float value[4], float stored[4]);

// The pass for images of this storage, and for buffers of this format's texel size.
PassSpec clear_region_spec(Storage storage, Resource resource, PixelFormat format);

// One kernel serves images of all formats, and buffers of all formats of one texel size: that of the spec's use.
class ClearRegionPass : public Pass {
 public:
  using Pass::Pass;

  // `image` has the plan's storage and, in a buffer, a format of the same texel size; `render` lies inside it.
  void clear(const PassFrame& frame, const ImageView& image, Extent render, const float value[4],
             cl::Event* event);

  bool serves(const ImageView& image) const {
    return image.storage == Storage::kImage ||
           bytes_per_pixel(image.format) == spec().uses.front().element_bytes();
  }

  // Clears the viewport of the spec's resource to zero.
  void enqueue(const PassFrame& frame, cl::Event* event) override;
};

}  // namespace quincunx
