// SPDX-License-Identifier: MIT
// ScalePass: scale_point or scale_bilinear, from one rendered frame to the output extent.
#pragma once

#include "axis_table.h"
#include "pass_common.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

class ScalePass {
 public:
  // kPoint takes scale_point; any other method scale_bilinear, which is also what the quincunx resolve gives
  // bit for bit where the previous frame has no weight.
  ScalePass(const Device::Impl& device, Method method, const ResolveSettings& settings);

  const char* kernel_name() const { return name_; }  // static string

  void warm_up(const cl::CommandQueue& queue);  // blocks

  // Reads inputs.colour, render and jitter; writes the whole output extent of `output`.
  void enqueue(const cl::CommandQueue& queue, AxisTables& tables, const FrameInputs& inputs,
               const ImageView& output, Counter counter, cl::Event* event);

 private:
  const Device::Impl& device_;
  ResolveSettings settings_;
  const char* name_;
  cl::Kernel kernel_;
};

}  // namespace quincunx
