// SPDX-License-Identifier: MIT
#include "pass_scale.h"

#include "kernel_options.h"
#include "program_cache.h"

namespace quincunx {

ScalePass::ScalePass(const Device::Impl& device, Method method, const ResolveSettings& settings)
    : device_(device),
      settings_(settings),
      name_(method == Method::kPoint ? "scale_point" : "scale_bilinear"),
      kernel_(build_kernel(device, name_, scale_options(settings))) {}

void ScalePass::warm_up(const cl::CommandQueue& queue) {
  Scratch scratch(device_);
  AxisTables tables(device_, {1, 1});
  FrameInputs inputs;
  inputs.colour = scratch.view(settings_.storage, settings_.colour);
  inputs.render = inputs.colour.extent;
  enqueue(queue, tables, inputs, scratch.view(Storage::kBuffer, settings_.resolved), scratch.counter(),
          nullptr);
  queue.finish();
}

void ScalePass::enqueue(const cl::CommandQueue& queue, AxisTables& tables, const FrameInputs& inputs,
                        const ImageView& output, Counter counter, cl::Event* event) {
  const Extent extent = tables.output();
  const ScaleParams params{.output_width = extent.width,
                           .output_height = extent.height,
                           .source_width = inputs.render.width,
                           .source_height = inputs.render.height,
                           .source = layout_of(inputs.colour),
                           .output = layout_of(output),
                           .row_axis = tables.row_axis(),
                           .counter = counter.index,
                           .columns_per_item = columns_per_item(device_, extent.width)};
  kernel_.setArg(0, params);
  kernel_.setArg(1, tables.get(queue, inputs.render, inputs.jitter));
  set_memory(kernel_, 2, inputs.colour.memory);
  set_memory(kernel_, 3, output.memory);
  set_memory(kernel_, 4, counter.memory);
  enqueue_rows(device_, queue, kernel_, extent, params.columns_per_item, event);
}

}  // namespace quincunx
