// SPDX-License-Identifier: MIT
#include "passes/pass.h"

#include <fmt/format.h>

#include <algorithm>

#include "device/program_cache.h"

namespace quincunx {
namespace {

int round_up(int value, int step) {
  return (value + step - 1) / step * step;
}

// Work-items that fill a compute unit: as many as a multiprocessor of NVIDIA's holds at once, or enough of a CPU's that
// threads end alike.
constexpr int kItemsOfGpuUnit = 2048;
constexpr int kItemsOfCpuUnit = 16;

std::string options_of(const PassSpec& spec, const Device::Impl& device) {
  if (spec.registers == 0 || !device.limits_registers) return spec.options;
  return fmt::format("{} -cl-nv-maxrregcount={}", spec.options, spec.registers);
}

std::size_t max_items(const cl::Kernel& kernel, const Device::Impl& device) {
  return kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device.device);
}

// PoCL 6 with LLVM 19 crashes in kernel `exposure` where the group is of one work-item.
constexpr std::size_t kLeastItemsOfOneGroup = 32;

}  // namespace

Pass::Pass(const PassSetup& setup, const PassSpec& spec)
    : facts_(setup.facts),
      spec_(spec),
      kernel_(build_kernel(setup.device, spec.kernel, options_of(spec, setup.device))),
      shape_(
          with_smaller_group(setup.device.profile.shape_of(spec.kernel), max_items(kernel_, setup.device))),
      lanes_(setup.device.lanes),
      items_at_once_(setup.device.info.compute_units * (lanes_ == 1 ? kItemsOfGpuUnit : kItemsOfCpuUnit)),
      items_of_one_group_(std::clamp(static_cast<std::size_t>(shape_.group_width * shape_.group_height),
                                     std::min(kLeastItemsOfOneGroup, max_items(kernel_, setup.device)),
                                     max_items(kernel_, setup.device))) {
  for (const Use& use : spec_.uses)
    uses_[index_of(use.resource)] = true;
  stand_ins_[0] = setup.tables.stand_in(Storage::kBuffer);
  if (settings().targets.storage == Storage::kImage) stand_ins_[1] = setup.tables.stand_in(Storage::kImage);
}

bool Pass::takes_part(const PassFrame& frame) const {
  const auto serves = [&] {
    const bool dense = is_dense(frame.inputs.render_extent, frame.output);
    switch (spec_.frames) {
      case Frames::kAll:
        return true;
      case Frames::kWithHistory:
        return frame.has_history;
      case Frames::kWithoutHistory:
        return !frame.has_history;
      case Frames::kSparse:
        return !dense;
      case Frames::kDense:
        return dense;
      case Frames::kWithFocus:
        return frame.focus != nullptr;
      case Frames::kFading:
        return static_cast<bool>(frame.inputs.fading_from);
      case Frames::kResized:
        return !dense && frame.resizes_history();
      case Frames::kScaledOutput:
        return frame.scales_output;
      case Frames::kOnRequest:
        return false;
    }
    return false;
  };
  if (spec_.viewports == Viewports::kAll) return serves();
  return widens(frame.inputs.render_extent, frame.output) == (spec_.viewports == Viewports::kWider) &&
         serves();
}

cl_mem Pass::stand_in_for(Resource resource) const {
  return stand_ins_[storage_of(resource, facts_) == Storage::kImage ? 1 : 0]();
}

void set_memory(cl::Kernel& kernel, cl_uint index, cl_mem memory) {
  kernel.setArg(index, sizeof(memory), &memory);
}

void enqueue_rows(const WorkShape& shape, const cl::CommandQueue& queue, const cl::Kernel& kernel,
                  Extent extent, int columns, cl::Event* event, int rows) {
  const int group_x = shape.group_width;
  const int group_y =
      shape.pixels_per_item == 0 ? std::max(shape.group_height / rows, 1) : shape.group_height;
  const int items_x = (extent.width + columns - 1) / columns;
  const int items_y = (extent.height + rows - 1) / rows;
  queue.enqueueNDRangeKernel(
      kernel, cl::NullRange,
      cl::NDRange(static_cast<std::size_t>(round_up(items_x, group_x)),
                  static_cast<std::size_t>(round_up(items_y, group_y))),
      cl::NDRange(static_cast<std::size_t>(group_x), static_cast<std::size_t>(group_y)), nullptr, event);
}

void Pass::launch_group(const PassFrame& frame, cl::Event* event) {
  const cl::NDRange group(items_of_one_group_);
  frame.queue.enqueueNDRangeKernel(kernel_, cl::NullRange, group, group, nullptr, event);
}

void Pass::launch_over_list(const PassFrame& frame, cl::Event* event) {
  const int group = shape_.group_width * shape_.group_height;
  frame.queue.enqueueNDRangeKernel(kernel_, cl::NullRange,
                                   cl::NDRange(static_cast<std::size_t>(round_up(items_at_once_, group))),
                                   cl::NDRange(static_cast<std::size_t>(group)), nullptr, event);
}

TexelLayout layout_of(const ImageView& view) {
  const std::size_t texel = bytes_per_pixel(view.format);
  if (view.storage == Storage::kImage || texel == 0) return {0, 0};
  const auto pitch = static_cast<std::ptrdiff_t>(view.row_pitch());  // negative where inputs.h turns rows
  return {static_cast<int>(view.offset / texel),
          static_cast<int>(pitch / static_cast<std::ptrdiff_t>(texel))};
}

TexelLayout rows_of(const ImageView& view, int height, Origin origin) {
  if (view.storage != Storage::kImage) return layout_of(view);
  return origin == Origin::kTop ? TexelLayout{0, 1} : TexelLayout{height - 1, -1};
}

VelocityScale velocity_scale_to(const FrameInputs& inputs, Extent extent) {
  const Vec2 to_uv = inputs.velocity_scale != Vec2{} ? inputs.velocity_scale : Vec2{1, 1};
  return {static_cast<double>(to_uv.x) * extent.width, static_cast<double>(to_uv.y) * extent.height};
}

Ratio ratio_of(Extent to, Extent from) {
  return {static_cast<float>(static_cast<double>(to.width) / from.width),
          static_cast<float>(static_cast<double>(to.height) / from.height)};
}

WorkShape with_smaller_group(WorkShape shape, std::size_t most) {
  while (static_cast<std::size_t>(shape.group_width) * static_cast<std::size_t>(shape.group_height) > most) {
    int& longer = shape.group_width > shape.group_height ? shape.group_width : shape.group_height;
    if (longer == 1) break;
    longer /= 2;
  }
  return shape;
}

int columns_per_item(const WorkShape& shape, int width, int block) {
  const int pixels = shape.pixels_per_item;
  return round_up(pixels == 0 ? width : std::min(pixels, width), block);
}

const char* precision_of(PixelFormat format) {
  return format == PixelFormat::kRGBA16F || format == PixelFormat::kRG16F ? "HALF" : "FLOAT";
}

const char* storage_option(Storage storage) {
  return storage == Storage::kImage ? "IMAGE" : "BUFFER";
}

std::string colour_options(const ResolveSettings& settings) {
  const bool encoded = settings.colour == PixelFormat::kRGBA8;
  if (settings.targets.storage == Storage::kImage)
    return encoded ? "-D SOURCE_STORAGE=IMAGE -D SOURCE_FORMAT=SRGB8" : "-D SOURCE_STORAGE=IMAGE";
  return fmt::format("-D SOURCE_STORAGE=BUFFER -D SOURCE_FORMAT={}",
                     encoded ? "SRGB8" : precision_of(settings.colour));
}

std::string scale_options(const ResolveSettings& settings) {
  return fmt::format("{} -D OUTPUT_FORMAT={}", colour_options(settings),
                     precision_of(settings.output.linear));
}

std::string velocity_options(const ResolveSettings& settings) {
  if (settings.targets.storage == Storage::kImage) return "-D SOURCE_STORAGE=IMAGE";
  return fmt::format("-D SOURCE_STORAGE=BUFFER -D VELOCITY_FORMAT={}", precision_of(settings.velocity));
}

}  // namespace quincunx
