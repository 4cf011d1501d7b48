// SPDX-License-Identifier: MIT
// Frames of the C interface as the library's own, with images in host memory, and reports back. Pure, but for
// HostImages.
#pragma once

#include <array>
#include <cstddef>

#include "quincunx/c_frame.h"
#include "quincunx/device.h"
#include "quincunx/resolve_service.h"

namespace quincunx::c {

// An image in host memory that stands for `view`, whose memory is then only a name for it.
struct HostMemory {
  void* texels = nullptr;     // null: the image is a memory object
  std::size_t row_bytes = 0;  // from one row to the next; 0: tightly packed
};

constexpr std::array kInputImages = {&FrameInputs::colour, &FrameInputs::depth, &FrameInputs::velocity,
                                     &FrameInputs::reactive};
constexpr std::array kOutputImages = {&FrameOutputs::linear, &FrameOutputs::presented};

struct Frame {
  FrameInputs inputs;
  FrameOutputs outputs;
  std::array<HostMemory, kInputImages.size()> host_inputs;
  std::array<HostMemory, kOutputImages.size()> host_outputs;
};

// Returns a frame that has passed validate(). Errors: kInvalidArgument; the message names the field.
Result<Frame> checked_frame(const ResolvePlan& plan, const quincunx_inputs* inputs,
                            const quincunx_outputs* outputs);

// Reads a view of a memory object. Errors: kInvalidArgument.
Result<ImageView> memory_object(const char* name, const quincunx_image* image);

Status check_report(const quincunx_report* report);
void write_report(const FrameReport& from, quincunx_report* to);  // that check_report() likes

// Lets a service read and write host memory, by images of its own on the device. They are made when host memory is
// first given in their place, and kept: two for each input, since the frame before is still read, and one for each
// output. As thread safe as its Device.
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
  std::array<Inputs, 2> inputs_;  // this frame's and those of the one before, in turns
  std::size_t turn_ = 0;
  std::array<Image, kOutputImages.size()> outputs_;
};

}  // namespace quincunx::c
