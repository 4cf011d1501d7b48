// SPDX-License-Identifier: MIT
#include "pass_resolve.h"

#include <algorithm>
#include <cmath>

#include "kernel_options.h"
#include "program_cache.h"

namespace quincunx {
namespace {

// The image that the weight is made from; empty where nothing moves.
const ImageView& motion_of(const FrameInputs& frame, VelocitySource velocity) {
  return velocity == VelocitySource::kCamera ? frame.depth : frame.velocity;
}

SourceFrame source_of(const FrameInputs& frame, VelocitySource velocity) {
  SourceFrame source{};
  source.width = frame.render.width;
  source.height = frame.render.height;
  source.colour = layout_of(frame.colour);
  if (velocity != VelocitySource::kNone) source.velocity = layout_of(motion_of(frame, velocity));
  return source;
}

// From the velocity of one frame to sqrt(K) of its render pixels.
Vec2 speed_scale(const FrameInputs& frame, VelocitySource velocity, float weight) {
  Vec2 to_uv = {1, 1};
  if (velocity == VelocitySource::kTarget && frame.velocity_scale != Vec2{}) to_uv = frame.velocity_scale;
  const double root = std::sqrt(static_cast<double>(weight));
  return {static_cast<float>(root * frame.render.width * to_uv.x),
          static_cast<float>(root * frame.render.height * to_uv.y)};
}

CameraVelocity camera_of(const FrameInputs& frame) {
  const double width = frame.render.width;
  const double height = frame.render.height;
  CameraVelocity camera{};
  camera.step_x = static_cast<float>(2 / width);
  camera.step_y = static_cast<float>(-2 / height);
  camera.start_x = static_cast<float>((1 + 2.0 * frame.jitter.x) / width - 1);
  camera.start_y = static_cast<float>(1 - (1 + 2.0 * frame.jitter.y) / height);
  std::copy(frame.camera.clip_to_previous_clip.begin(), frame.camera.clip_to_previous_clip.end(),
            camera.to_previous);
  return camera;
}

}  // namespace

ResolvePass::ResolvePass(const Device::Impl& device, const ResolvePlan& plan)
    : device_(device),
      settings_(plan.settings),
      velocity_(plan.velocity),
      reads_reactive_(plan.reads_reactive),
      kernel_(build_kernel(device, kernel_name(), quincunx_options(plan))) {}

void ResolvePass::warm_up(const cl::CommandQueue& queue) {
  Scratch scratch(device_);
  AxisTables tables(device_, {1, 1});
  FrameInputs frame;
  frame.colour = scratch.view(settings_.storage, settings_.colour);
  frame.velocity = scratch.view(settings_.storage, settings_.velocity);
  frame.depth = scratch.view(settings_.storage, PixelFormat::kR32F);
  frame.reactive = scratch.view(settings_.storage, PixelFormat::kR8);
  frame.render = frame.colour.extent;
  enqueue(queue, tables, frame, frame, scratch.view(Storage::kBuffer, settings_.resolved), scratch.counter(),
          nullptr);
  queue.finish();
}

ResolveParams ResolvePass::params_for(Extent output, const FrameInputs& current,
                                      const FrameInputs& previous) const {
  const Vec2 scale0 = speed_scale(current, velocity_, settings_.velocity_weight);
  const Vec2 scale1 = speed_scale(previous, velocity_, settings_.velocity_weight);
  ResolveParams params{};
  params.output_width = output.width;
  params.output_height = output.height;
  params.frame0 = source_of(current, velocity_);
  params.frame1 = source_of(previous, velocity_);
  if (reads_reactive_) params.frame0.reactive = layout_of(current.reactive);
  params.velocity0_scale_x = scale0.x;
  params.velocity0_scale_y = scale0.y;
  params.velocity1_scale_x = scale1.x;
  params.velocity1_scale_y = scale1.y;
  if (velocity_ == VelocitySource::kCamera) {
    params.camera0 = camera_of(current);
    params.camera1 = camera_of(previous);
  }
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
  const bool reads_motion = velocity_ != VelocitySource::kNone;
  set_memory(kernel_, index++, (reads_motion ? motion_of(current, velocity_) : current.colour).memory);
  set_memory(kernel_, index++, (reads_motion ? motion_of(previous, velocity_) : previous.colour).memory);
  set_memory(kernel_, index++, (reads_reactive_ ? current.reactive : current.colour).memory);
  set_memory(kernel_, index++, output.memory);
  set_memory(kernel_, index++, counter.memory);
  enqueue_rows(device_, queue, kernel_, extent, params.columns_per_item, event);
}

}  // namespace quincunx
