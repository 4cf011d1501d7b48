// SPDX-License-Identifier: MIT
// VelocityPass: velocity_from_depth, the velocity target of a frame in which only the camera moves.
#pragma once

#include "pass_common.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

class VelocityPass {
 public:
  VelocityPass(const Device::Impl& device, const ResolveSettings& settings);

  static constexpr const char* kernel_name() { return "velocity_from_depth"; }

  void warm_up(const cl::CommandQueue& queue);  // blocks

  // Reads depth, render, jitter and camera of `inputs`; writes the viewport of `velocity`, which has the
  // settings' storage and velocity format, in uv.
  void enqueue(const cl::CommandQueue& queue, const FrameInputs& inputs, const ImageView& velocity,
               cl::Event* event);

 private:
  const Device::Impl& device_;
  ResolveSettings settings_;
  cl::Kernel kernel_;
};

}  // namespace quincunx
