// SPDX-License-Identifier: MIT
// HostImages: lets a service read and write host memory, by images of its own on the device.
#pragma once

#include <array>

#include "c_interface/c_frame.h"
#include "quincunx/device.h"

namespace quincunx::c {

// Images are made when host memory is first given in their place, and kept: two for each input, since the frame before
// is still read, and one for each output. As thread safe as its Device.
class HostImages {
 public:
  HostImages(const Device& device, const ResolvePlan& plan);

  // Copies inputs of host memory to the device and makes the frame's views name the copies. Errors: of the device.
  Status bring(Frame& frame);

  // After a frame was dispatched: waits for it where its outputs are host memory, and copies them there. Errors: of the
  // device.
  Status fetch(const Frame& frame);

 private:
  using Inputs = std::array<Image, kInputImages.size()>;

  Status input(Image& image, const HostMemory& host, Extent render, ImageView& view) const;
  Status make(Image& image, Extent extent, const ImageView& like) const;

  Device device_;
  Extent target_;
  Extent output_;
  bool placed_;
  std::array<Inputs, 2> inputs_;  // of this frame and the one before, in turns
  std::size_t turn_ = 0;
  std::array<Image, kOutputImages.size()> outputs_;
};

}  // namespace quincunx::c
