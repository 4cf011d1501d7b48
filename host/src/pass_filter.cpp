// SPDX-License-Identifier: MIT
#include "pass_filter.h"

#include <algorithm>
#include <cmath>

#include "axis_table.h"
#include "kernel_options.h"
#include "program_cache.h"

namespace quincunx {
namespace {

constexpr int kFourTaps = 4;

// Output pixels, in whole blocks, whose columns fit into the kernel's array: the first and the last pixel of
// a run of n are (n - 1) * render / output texels apart, and both may round.
int run_length(int render, int output, int taps, int columns) {
  const double step = static_cast<double>(render) / output;
  const int fitting = static_cast<int>((kFilterColumns - taps - 1) / step) + 1;
  return std::min(fitting / kBlock * kBlock, columns);
}

}  // namespace

FilterPass::FilterPass(const Device::Impl& device, Filter filter, const ResolveSettings& settings)
    : device_(device), settings_(settings), tables_(device, filter, settings.target, settings.output) {
  if (filter != Filter::kTent)
    four_taps_ = build_kernel(device, kernel_name(), filter_options(filter, settings, kFourTaps));
  if (!four_taps_ || widens(settings.target, settings.output))
    any_taps_ = build_kernel(device, kernel_name(), filter_options(filter, settings, 0));
}

void FilterPass::warm_up(const cl::CommandQueue& queue) {
  Scratch scratch(device_);
  const ImageView output = scratch.view(Storage::kBuffer, settings_.resolved);
  FrameInputs inputs;
  inputs.colour = scratch.view(settings_.storage, settings_.colour);
  inputs.render = inputs.colour.extent;
  ResolveSettings small = settings_;
  small.output = output.extent;
  small.target = inputs.render;
  FilterTables tables(device_, tables_.filter(), small.target, small.output);
  for (std::optional<cl::Kernel>* kernel : {&four_taps_, &any_taps_}) {
    if (*kernel) launch(queue, **kernel, tables, inputs, output, scratch.counter(), nullptr);
  }
  queue.finish();
}

void FilterPass::enqueue(const cl::CommandQueue& queue, const FrameInputs& inputs, const ImageView& output,
                         Counter counter, cl::Event* event) {
  const bool four = four_taps_ && !widens(inputs.render, settings_.output);
  launch(queue, four ? *four_taps_ : *any_taps_, tables_, inputs, output, counter, event);
}

void FilterPass::launch(const cl::CommandQueue& queue, cl::Kernel& kernel, FilterTables& tables,
                        const FrameInputs& inputs, const ImageView& output, Counter counter,
                        cl::Event* event) {
  const Extent extent = tables.output();
  const int taps_x = filter_taps(tables.filter(), inputs.render.width, extent.width);
  const int taps_y = filter_taps(tables.filter(), inputs.render.height, extent.height);
  const int columns = columns_per_item(device_, extent.width);
  const bool narrow = inputs.render.width < std::max<int>(taps_x, kBlock) || inputs.render.height < taps_y;
  const FilterParams params{
      .output_width = extent.width,
      .output_height = extent.height,
      .source_width = inputs.render.width,
      .source_height = inputs.render.height,
      .source = layout_of(inputs.colour),
      .output = layout_of(output),
      .row_axis = padded_columns(extent),
      .taps_x = taps_x,
      .taps_y = taps_y,
      .inner_x = filter_inner(inputs.render.width, extent.width),
      .inner_y = filter_inner(inputs.render.height, extent.height),
      .run = narrow ? 0 : std::max(run_length(inputs.render.width, extent.width, taps_x, columns), 0),
      .counter = counter.index,
      .columns_per_item = columns};
  kernel.setArg(0, params);
  kernel.setArg(1, tables.get(queue, inputs.render, inputs.jitter));
  set_memory(kernel, 2, inputs.colour.memory);
  set_memory(kernel, 3, output.memory);
  set_memory(kernel, 4, counter.memory);
  enqueue_rows(device_, queue, kernel, extent, columns, event);
}

}  // namespace quincunx
