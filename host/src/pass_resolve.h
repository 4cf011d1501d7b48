// SPDX-License-Identifier: MIT
// ResolvePass: resolve_quincunx, from this frame and the previous one to the output extent.
#pragma once

#include "axis_table.h"
#include "pass_common.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

class ResolvePass {
 public:
  ResolvePass(const Device::Impl& device, const ResolvePlan& plan);

  static constexpr const char* kernel_name() { return "resolve_quincunx"; }

  void warm_up(const cl::CommandQueue& queue);  // blocks

  // Reads of `current`: colour, velocity and reactive as planned, render, jitter, velocity_scale; of
  // `previous` the same. Writes the whole output extent of `output`.
  void enqueue(const cl::CommandQueue& queue, AxisTables& tables, const FrameInputs& current,
               const FrameInputs& previous, const ImageView& output, Counter counter, cl::Event* event);

 private:
  ResolveParams params_for(Extent output, const FrameInputs& current, const FrameInputs& previous) const;

  const Device::Impl& device_;
  ResolveSettings settings_;
  bool reads_velocity_;
  bool reads_reactive_;
  cl::Kernel kernel_;
};

}  // namespace quincunx
