// SPDX-License-Identifier: MIT
#include "pass_common.h"

#include <vector>

namespace quincunx {
namespace {

constexpr int kScratchSide = 2;

int round_up(int value, int step) {
  return (value + step - 1) / step * step;
}

}  // namespace

TexelLayout layout_of(const ImageView& view) {
  if (view.storage == Storage::kImage) return {0, 0};
  const std::size_t texel = bytes_per_pixel(view.format);
  return {static_cast<int>(view.offset / texel), static_cast<int>(view.row_pitch() / texel)};
}

VelocityScale velocity_scale_to(const FrameInputs& frame, Extent extent) {
  const Vec2 to_uv = frame.velocity_scale != Vec2{} ? frame.velocity_scale : Vec2{1, 1};
  return {static_cast<double>(to_uv.x) * extent.width, static_cast<double>(to_uv.y) * extent.height};
}

void set_memory(cl::Kernel& kernel, cl_uint index, cl_mem memory) {
  kernel.setArg(index, sizeof(memory), &memory);
}

int columns_per_item(const Device::Impl& device, int width, int block) {
  return device.info.kind == DeviceKind::kCpu ? round_up(width, block) : block;
}

void enqueue_rows(const Device::Impl& device, const cl::CommandQueue& queue, const cl::Kernel& kernel,
                  Extent extent, int columns, cl::Event* event) {
  // A CPU runs a group in one thread, a GPU wants a compact tile.
  const bool cpu = device.info.kind == DeviceKind::kCpu;
  const int group_x = cpu ? 1 : 16;
  const int group_y = cpu ? 4 : 8;
  const int items_x = (extent.width + columns - 1) / columns;
  queue.enqueueNDRangeKernel(
      kernel, cl::NullRange,
      cl::NDRange(static_cast<std::size_t>(round_up(items_x, group_x)),
                  static_cast<std::size_t>(round_up(extent.height, group_y))),
      cl::NDRange(static_cast<std::size_t>(group_x), static_cast<std::size_t>(group_y)), nullptr, event);
}

ImageView Scratch::view(Storage storage, PixelFormat format) {
  ImageView view{.storage = storage, .format = format, .extent = {kScratchSide, kScratchSide}};
  if (storage == Storage::kImage) {
    // Kernels take images of any format; these two exist everywhere.
    const cl::ImageFormat channels(CL_RGBA, format == PixelFormat::kRGBA8 ? CL_UNORM_INT8 : CL_FLOAT);
    memory_.push_back(cl::Image2D(device_.context, CL_MEM_READ_WRITE, channels, kScratchSide, kScratchSide));
  } else {
    memory_.push_back(cl::Buffer(device_.context, CL_MEM_READ_WRITE,
                                 kScratchSide * kScratchSide * bytes_per_pixel(format)));
  }
  view.memory = memory_.back()();
  return view;
}

FrameInputs Scratch::frame(const ResolveSettings& settings) {
  FrameInputs frame;
  frame.colour = view(settings.storage, settings.colour);
  frame.velocity = view(settings.storage, settings.velocity);
  frame.depth = view(settings.storage, PixelFormat::kR32F);
  frame.reactive = view(settings.storage, PixelFormat::kR8);
  frame.render = {1, 1};
  return frame;
}

Counter Scratch::counter() {
  memory_.push_back(cl::Buffer(device_.context, CL_MEM_READ_WRITE, sizeof(cl_uint)));
  return {memory_.back()(), 0};
}

}  // namespace quincunx
