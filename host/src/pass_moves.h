// SPDX-License-Identifier: MIT
// MovePass: the kernel reproject, which finds where the samples of a frame were in the previous one.
#pragma once

#include <array>

#include "pass_common.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

class MovePass {
 public:
  // Serves viewports up to the plan's target.
  MovePass(const Device::Impl& device, const ResolvePlan& plan);

  static const char* kernel_name() { return "reproject"; }

  // Reads of both frames: velocity and depth, reactive where the plan does, render, jitter; of `previous`
  // velocity only where residuals count.
  void enqueue(const cl::CommandQueue& queue, const FrameInputs& current, const FrameInputs& previous,
               cl::Event* event);

  // What the next enqueue() finds of the frame before is nothing.
  void forget(const cl::CommandQueue& queue);

  // What was written last: Reprojection of each sample, the settings' target extent as RGBA32F.
  ImageView view() const;

 private:
  const Device::Impl& device_;
  ResolveSettings settings_;
  bool reads_reactive_;
  bool reads_residual_;
  cl::Kernel kernel_;
  std::array<cl::Buffer, 2> moves_;  // the second only where the previous frame's are read
  std::size_t newest_ = 0;
};

}  // namespace quincunx
