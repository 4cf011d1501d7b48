// SPDX-License-Identifier: MIT
#include "pass_scale.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "kernel_options.h"
#include "program_cache.h"

namespace quincunx {
namespace {

bool is_noise(Method method) {
  return method == Method::kNoise || method == Method::kNoiseOffset;
}

bool is_wide(Method method) {
  return filter_of(method) != Filter::kTent;
}

// The kernel for viewports up to the output's size.
const char* small_kernel(Method method) {
  switch (method) {
    case Method::kPoint:
      return "scale_point";
    case Method::kNoise:
      return "scale_noise";
    case Method::kNoiseOffset:
      return "scale_noise_offset";
    case Method::kBSpline:
    case Method::kCatmullRom:
    case Method::kLanczos2:
      return FilterPass::kernel_name();
    case Method::kBilinear:
    case Method::kQuincunx:
    case Method::kTemporal:
      return "scale_bilinear";
  }
  return "scale_bilinear";
}

bool skips(Method method) {
  return method == Method::kPoint || is_noise(method);
}

// Grain stands in for the detail that is missing: none at scale 1, all of it at scale 0.
float grain_amplitude(float grain, Extent render, Extent output) {
  const double scale = std::sqrt(static_cast<double>(render.area()) / static_cast<double>(output.area()));
  return static_cast<float>(grain * std::max(0.0, 1 - scale));
}

// Of an output pixel, in 1/256 texels; a texel at least, and what the kernel's integers hold.
int random_reach(int render, int output) {
  const double ratio = static_cast<double>(render) / output;
  return static_cast<int>(std::nearbyint(std::clamp(ratio, 1.0, 250.0) * 256));
}

}  // namespace

const char* scale_kernel(Method method, Extent render, Extent output) {
  const bool widened = widens(render, output) && !skips(method);
  return widened ? FilterPass::kernel_name() : small_kernel(method);
}

ScalePass::ScalePass(const Device::Impl& device, Method method, const ResolveSettings& settings)
    : device_(device), method_(method), settings_(settings) {
  if (!is_wide(method)) kernel_ = build_kernel(device, small_kernel(method), scale_options(settings));
  if (is_wide(method) || (widens(settings.target, settings.output) && !skips(method)))
    filter_.emplace(device, filter_of(method), settings);
}

void ScalePass::warm_up(const cl::CommandQueue& queue) {
  if (filter_) filter_->warm_up(queue);
  if (!kernel_) return;
  Scratch scratch(device_);
  AxisTables tables(device_, {1, 1});
  FrameInputs inputs;
  inputs.colour = scratch.view(settings_.storage, settings_.colour);
  inputs.render = inputs.colour.extent;
  launch(queue, tables, inputs, scratch.view(Storage::kBuffer, settings_.resolved), scratch.counter(),
         nullptr);
  queue.finish();
}

void ScalePass::enqueue(const cl::CommandQueue& queue, AxisTables& tables, const FrameInputs& inputs,
                        const ImageView& output, Counter counter, cl::Event* event) {
  if (kernel_name(inputs.render) == std::string_view(FilterPass::kernel_name())) {
    filter_->enqueue(queue, inputs, output, counter, event);
  } else {
    launch(queue, tables, inputs, output, counter, event);
  }
}

void ScalePass::launch(const cl::CommandQueue& queue, AxisTables& tables, const FrameInputs& inputs,
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
  if (is_noise(method_)) {
    const auto seed = static_cast<unsigned>(settings_.noise_moves ? inputs.frame_index : 0);
    kernel_->setArg(0, NoiseParams{params, seed, grain_amplitude(settings_.grain, inputs.render, extent),
                                   random_reach(inputs.render.width, extent.width),
                                   random_reach(inputs.render.height, extent.height)});
  } else {
    kernel_->setArg(0, params);
  }
  kernel_->setArg(1, tables.get(queue, inputs.render, inputs.jitter));
  set_memory(*kernel_, 2, inputs.colour.memory);
  set_memory(*kernel_, 3, output.memory);
  set_memory(*kernel_, 4, counter.memory);
  enqueue_rows(device_, queue, *kernel_, extent, params.columns_per_item, event);
}

}  // namespace quincunx
