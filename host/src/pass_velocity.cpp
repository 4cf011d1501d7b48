// SPDX-License-Identifier: MIT
#include "pass_velocity.h"

#include <algorithm>

#include "kernel_options.h"
#include "program_cache.h"

namespace quincunx {
namespace {

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

VelocityPass::VelocityPass(const Device::Impl& device, const ResolveSettings& settings)
    : device_(device),
      settings_(settings),
      kernel_(build_kernel(device, kernel_name(), velocity_options(settings))) {}

void VelocityPass::warm_up(const cl::CommandQueue& queue) {
  Scratch scratch(device_);
  FrameInputs inputs;
  inputs.depth = scratch.view(settings_.storage, PixelFormat::kR32F);
  inputs.render = inputs.depth.extent;
  enqueue(queue, inputs, scratch.view(settings_.storage, settings_.velocity), nullptr);
  queue.finish();
}

void VelocityPass::enqueue(const cl::CommandQueue& queue, const FrameInputs& inputs,
                           const ImageView& velocity, cl::Event* event) {
  const VelocityParams params{.width = inputs.render.width,
                              .height = inputs.render.height,
                              .depth = layout_of(inputs.depth),
                              .velocity = layout_of(velocity),
                              .columns_per_item = columns_per_item(device_, inputs.render.width),
                              .camera = camera_of(inputs)};
  kernel_.setArg(0, params);
  set_memory(kernel_, 1, inputs.depth.memory);
  set_memory(kernel_, 2, velocity.memory);
  enqueue_rows(device_, queue, kernel_, inputs.render, params.columns_per_item, event);
}

}  // namespace quincunx
