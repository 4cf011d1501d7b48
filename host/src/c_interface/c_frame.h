// SPDX-License-Identifier: MIT
// Frames of the C interface as the library's own, and reports back. Pure.
#pragma once

#include <array>
#include <cstddef>

#include "quincunx/c_frame.h"
#include "quincunx/resolve_service.h"

namespace quincunx::c {

// An image in host memory that stands for `view`, whose memory is then only a name for it.
struct HostMemory {
  void* texels = nullptr;     // null: the image is a memory object
  std::size_t row_bytes = 0;  // from one row to the next; 0: tightly packed
};

constexpr std::array kInputImages = {&FrameInputs::colour, &FrameInputs::depth, &FrameInputs::velocity,
                                     &FrameInputs::reactive};
constexpr std::array kOutputImages = {&FrameOutputs::resolved, &FrameOutputs::presented,
                                      &FrameOutputs::blurred};

struct Frame {
  FrameInputs inputs;
  FrameOutputs outputs;
  std::array<HostMemory, kInputImages.size()> host_inputs;
  std::array<HostMemory, kOutputImages.size()> host_outputs;
};

// Errors: kInvalidArgument; the message names the field. The result has passed validate().
Result<Frame> checked_frame(const ResolvePlan& plan, const quincunx_inputs* inputs,
                            const quincunx_outputs* outputs);

// A memory object. Errors: kInvalidArgument.
Result<ImageView> memory_object(const char* name, const quincunx_image* image);

Status check_report(const quincunx_report* report);
void write_report(const FrameReport& from, quincunx_report* to);  // that check_report() likes

}  // namespace quincunx::c
