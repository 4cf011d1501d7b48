// SPDX-License-Identifier: MIT
#include "pass_resolve.h"

#include <cmath>

#include "kernel_options.h"
#include "program_cache.h"

namespace quincunx {
namespace {

SourceFrame source_of(const FrameInputs& frame, bool moves) {
  SourceFrame source{};
  source.width = frame.render.width;
  source.height = frame.render.height;
  source.colour = layout_of(frame.colour);
  if (moves) source.velocity = layout_of(frame.velocity);
  return source;
}

// From the velocity of one frame to sqrt(K) of its render pixels.
Vec2 speed_scale(const FrameInputs& frame, float weight) {
  const VelocityScale pixels = velocity_scale_to(frame, frame.render);
  const double root = std::sqrt(static_cast<double>(weight));
  return {static_cast<float>(root * pixels.x), static_cast<float>(root * pixels.y)};
}

}  // namespace

ResolvePass::ResolvePass(const Device::Impl& device, const ResolvePlan& plan)
    : device_(device),
      settings_(plan.settings),
      reads_velocity_(plan.weighs_velocity()),
      reads_reactive_(plan.reads_reactive),
      kernel_(build_kernel(device, kernel_name(), quincunx_options(plan))) {}

void ResolvePass::warm_up(const cl::CommandQueue& queue) {
  Scratch scratch(device_);
  AxisTables tables(device_, {1, 1});
  FrameInputs frame;
  frame.colour = scratch.view(settings_.storage, settings_.colour);
  frame.velocity = scratch.view(settings_.storage, settings_.velocity);
  frame.reactive = scratch.view(settings_.storage, PixelFormat::kR8);
  frame.render = frame.colour.extent;
  enqueue(queue, tables, frame, frame, scratch.view(Storage::kBuffer, settings_.resolved), scratch.counter(),
          nullptr);
  queue.finish();
}

ResolveParams ResolvePass::params_for(Extent output, const FrameInputs& current,
                                      const FrameInputs& previous) const {
  const Vec2 scale0 = speed_scale(current, settings_.quincunx.velocity_weight);
  const Vec2 scale1 = speed_scale(previous, settings_.quincunx.velocity_weight);
  ResolveParams params{};
  params.output_width = output.width;
  params.output_height = output.height;
  params.frame0 = source_of(current, reads_velocity_);
  params.frame1 = source_of(previous, reads_velocity_);
  if (reads_reactive_) {
    params.frame0.reactive = layout_of(current.reactive);
    params.frame1.reactive = layout_of(previous.reactive);
  }
  params.velocity0_scale_x = scale0.x;
  params.velocity0_scale_y = scale0.y;
  params.velocity1_scale_x = scale1.x;
  params.velocity1_scale_y = scale1.y;
  return params;
}

void ResolvePass::enqueue(const cl::CommandQueue& queue, AxisTables& tables, const FrameInputs& current,
                          const FrameInputs& previous, const ImageView& output, Counter counter,
                          cl::Event* event) {
  const Extent extent = tables.output();
  ResolveParams params = params_for(extent, current, previous);
  params.output = layout_of(output);
  params.row_axis = tables.row_axis();
  params.counter = counter.index;
  params.columns_per_item = columns_per_item(device_, extent.width);
  cl_uint index = 0;
  kernel_.setArg(index++, params);
  kernel_.setArg(index++, tables.get(queue, current.render, current.jitter));
  kernel_.setArg(index++, tables.get(queue, previous.render, previous.jitter));
  set_memory(kernel_, index++, current.colour.memory);
  set_memory(kernel_, index++, previous.colour.memory);
  // What a variant does not read may be any image or buffer.
  set_memory(kernel_, index++, (reads_velocity_ ? current.velocity : current.colour).memory);
  set_memory(kernel_, index++, (reads_velocity_ ? previous.velocity : previous.colour).memory);
  set_memory(kernel_, index++, (reads_reactive_ ? current.reactive : current.colour).memory);
  set_memory(kernel_, index++, (reads_reactive_ ? previous.reactive : previous.colour).memory);
  set_memory(kernel_, index++, output.memory);
  set_memory(kernel_, index++, counter.memory);
  enqueue_rows(device_, queue, kernel_, extent, params.columns_per_item, event);
}

}  // namespace quincunx
