// SPDX-License-Identifier: MIT
// SlotImages: the images of one slot, in its part of the memory that GL and OpenCL use together.
#pragma once

#include <vector>

#include "frame_layout.h"
#include "pixel_buffer.h"

namespace quincunx::gl {

// What placed images must be: buffers, or images made on them (cl_khr_image2d_from_buffer).
struct PlacedForm {
  Storage storage = Storage::kBuffer;
  int row_texels = 1;  // rows start at multiples of so many texels
};

// Images on a device that can make them and gains by them, else buffers.
PlacedForm placed_form_for(const DeviceInfo& device);

class SlotImages {
 public:
  // In `pixels`, which outlives this object. Throws InteropError.
  SlotImages(const Device& device, const std::vector<Plane>& planes, const FrameLayout& layout,
             const PlacedForm& form, const PixelBuffer& pixels);

  // Makes placed images of this size, at most the layout's; nothing where they have it. OpenCL uses them no more.
  void resize(Extent render);

  Extent extent() const { return views_.colour.extent; }
  const SharedFrame& views() const { return views_; }      // for OpenCL
  const SharedFrame& regions() const { return regions_; }  // of the pixel buffer, for copies

 private:
  struct Surface {  // of form.storage kImage
    ClMem region;
    ClMem image;
  };

  Device device_;
  std::vector<Plane> planes_;
  PlacedForm form_;
  SharedFrame regions_;
  SharedFrame views_;
  std::vector<Surface> surfaces_;  // one for each plane
};

}  // namespace quincunx::gl
