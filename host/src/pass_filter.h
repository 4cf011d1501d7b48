// SPDX-License-Identifier: MIT
// FilterPass: scale_filter, from one rendered frame to the output extent through a separable filter of any
// width.
#pragma once

#include <optional>

#include "filter_table.h"
#include "pass_common.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

class FilterPass {
 public:
  // Serves viewports up to settings.target.
  FilterPass(const Device::Impl& device, Filter filter, const ResolveSettings& settings);

  static constexpr const char* kernel_name() { return "scale_filter"; }

  void warm_up(const cl::CommandQueue& queue);  // blocks

  // Reads inputs.colour, render and jitter; writes the whole output extent of `output`.
  void enqueue(const cl::CommandQueue& queue, const FrameInputs& inputs, const ImageView& output,
               Counter counter, cl::Event* event);

 private:
  void launch(const cl::CommandQueue& queue, cl::Kernel& kernel, FilterTables& tables,
              const FrameInputs& inputs, const ImageView& output, Counter counter, cl::Event* event);

  const Device::Impl& device_;
  ResolveSettings settings_;
  FilterTables tables_;
  std::optional<cl::Kernel> four_taps_;  // up to scale 1; none where the filter has two
  std::optional<cl::Kernel> any_taps_;   // above it; none where no viewport is larger than the output
};

}  // namespace quincunx
