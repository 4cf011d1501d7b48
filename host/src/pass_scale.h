// SPDX-License-Identifier: MIT
// ScalePass: one of the scale kernels, from one rendered frame to the output extent.
#pragma once

#include <optional>

#include "axis_table.h"
#include "pass_common.h"
#include "pass_filter.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

// The kernel that a method's frames of this size take; a static string. Pure.
const char* scale_kernel(Method method, Extent render, Extent output);

class ScalePass {
 public:
  // A method that blends frames takes scale_bilinear, which is also what the quincunx resolve gives bit for
  // bit where the previous frame has no weight. Serves viewports up to settings.target.
  ScalePass(const Device::Impl& device, Method method, const ResolveSettings& settings);

  const char* kernel_name(Extent render) const { return scale_kernel(method_, render, settings_.output); }

  void warm_up(const cl::CommandQueue& queue);  // blocks

  // Reads inputs.colour, render, jitter and, for noise, frame_index; writes the whole output extent of
  // `output`.
  void enqueue(const cl::CommandQueue& queue, AxisTables& tables, const FrameInputs& inputs,
               const ImageView& output, Counter counter, cl::Event* event);

 private:
  void launch(const cl::CommandQueue& queue, AxisTables& tables, const FrameInputs& inputs,
              const ImageView& output, Counter counter, cl::Event* event);

  const Device::Impl& device_;
  Method method_;
  ResolveSettings settings_;
  std::optional<cl::Kernel> kernel_;  // where axis tables do
  std::optional<FilterPass> filter_;  // of a wider filter, and of bilinear above scale 1
};

}  // namespace quincunx
