// SPDX-License-Identifier: MIT
#include "pass_motion_blur.h"

#include <algorithm>
#include <bit>

#include "kernel_options.h"
#include "program_cache.h"

namespace quincunx {
namespace {

int log2_of(int power) {
  return std::bit_width(static_cast<unsigned>(power)) - 1;
}

// From the units of the velocity target to streaks: a frame's motion in output pixels, times the open part of
// the frame.
Vec2 streak_scale(const FrameInputs& inputs, Extent output, float shutter) {
  const VelocityScale pixels = velocity_scale_to(inputs, output);
  const double units = static_cast<double>(shutter) * static_cast<int>(kStreakUnits);
  return {static_cast<float>(units * pixels.x), static_cast<float>(units * pixels.y)};
}

}  // namespace

MotionBlurPass::MotionBlurPass(const Device::Impl& device, const ResolveSettings& settings)
    : device_(device), settings_(settings) {
  kernels_ = {build_kernel(device, kKernels[0], velocity_options(settings)),
              build_kernel(device, kKernels[1], ""),
              build_kernel(device, kKernels[2], blur_options(settings))};
  const auto count = static_cast<std::size_t>(tiles().area());
  streaks_ = cl::Buffer(device.context, CL_MEM_READ_WRITE, count * sizeof(TileStreaks));
  longest_ = cl::Buffer(device.context, CL_MEM_READ_WRITE, sizeof(cl_int));
  blurs_ = cl::Buffer(device.context, CL_MEM_READ_WRITE, count * sizeof(TileBlur));
}

Extent MotionBlurPass::tiles_of(Extent output) {
  return {(output.width + kTileSide - 1) / kTileSide, (output.height + kTileSide - 1) / kTileSide};
}

void MotionBlurPass::warm_up(const cl::CommandQueue& queue) {
  Scratch scratch(device_);
  AxisTables tables(device_, {1, 1});
  FrameInputs frame;
  frame.velocity = scratch.view(settings_.storage, settings_.velocity);
  frame.depth = scratch.view(settings_.storage, PixelFormat::kR32F);
  frame.render = frame.velocity.extent;
  enqueue(queue, tables, frame, scratch.view(Storage::kBuffer, settings_.resolved),
          scratch.view(Storage::kBuffer, settings_.resolved), nullptr);
  queue.finish();
}

void MotionBlurPass::enqueue(const cl::CommandQueue& queue, AxisTables& tables, const FrameInputs& inputs,
                             const ImageView& resolved, const ImageView& blurred, cl::Event* events) {
  const Extent output = tables.output();
  const Extent grid = tiles_of(output);
  const Vec2 scale = streak_scale(inputs, output, settings_.blur.shutter);
  const MotionParams params{.output_width = output.width,
                            .output_height = output.height,
                            .tiles_x = grid.width,
                            .tiles_y = grid.height,
                            .source = layout_of(resolved),
                            .velocity = layout_of(inputs.velocity),
                            .depth = layout_of(inputs.depth),
                            .output = layout_of(blurred),
                            .row_axis = tables.row_axis(),
                            .columns_per_item = columns_per_item(device_, output.width),
                            .most_samples_log2 = log2_of(settings_.blur.samples),
                            .scale_x = scale.x,
                            .scale_y = scale.y};
  const cl::Buffer& axes = tables.get(queue, inputs.render, inputs.jitter);
  const auto event = [events](int i) { return events != nullptr ? events + i : nullptr; };
  const cl_int none = 0;
  queue.enqueueFillBuffer(longest_, none, 0, sizeof(none));

  cl::Kernel& tiles = kernels_[0];
  tiles.setArg(0, params);
  tiles.setArg(1, axes);
  set_memory(tiles, 2, inputs.velocity.memory);
  tiles.setArg(3, streaks_);
  tiles.setArg(4, longest_);
  enqueue_rows(device_, queue, tiles, grid, 1, event(0));

  cl::Kernel& neighbours = kernels_[1];
  neighbours.setArg(0, params);
  neighbours.setArg(1, streaks_);
  neighbours.setArg(2, longest_);
  neighbours.setArg(3, blurs_);
  enqueue_rows(device_, queue, neighbours, grid, 1, event(1));

  cl::Kernel& blur = kernels_[2];
  blur.setArg(0, params);
  blur.setArg(1, axes);
  blur.setArg(2, blurs_);
  set_memory(blur, 3, resolved.memory);
  set_memory(blur, 4, inputs.velocity.memory);
  set_memory(blur, 5, inputs.depth.memory);
  set_memory(blur, 6, blurred.memory);
  enqueue_rows(device_, queue, blur, output, params.columns_per_item, event(2));
}

std::vector<std::uint8_t> MotionBlurPass::tile_kinds(const cl::CommandQueue& queue) const {
  std::vector<TileBlur> blurs(static_cast<std::size_t>(tiles().area()));
  queue.enqueueReadBuffer(blurs_, CL_TRUE, 0, blurs.size() * sizeof(TileBlur), blurs.data());
  std::vector<std::uint8_t> kinds(blurs.size());
  std::transform(blurs.begin(), blurs.end(), kinds.begin(),
                 [](const TileBlur& blur) { return static_cast<std::uint8_t>(blur.kind); });
  return kinds;
}

}  // namespace quincunx
