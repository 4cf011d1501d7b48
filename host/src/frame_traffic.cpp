// SPDX-License-Identifier: MIT
#include "frame_traffic.h"

namespace quincunx {
namespace {

std::uint64_t bytes_of(Extent extent, PixelFormat format) {
  return static_cast<std::uint64_t>(extent.area()) * bytes_per_pixel(format);
}

std::uint64_t read_of_frame(const ResolvePlan& plan, Extent render) {
  std::uint64_t bytes = bytes_of(render, plan.settings.colour);
  if (plan.velocity != VelocitySource::kNone) bytes += bytes_of(render, plan.settings.velocity);
  return bytes;
}

}  // namespace

std::uint64_t scale_bytes(const ResolveSettings& settings, Extent render) {
  return bytes_of(render, settings.colour) + bytes_of(settings.output, settings.resolved);
}

std::uint64_t velocity_bytes(const ResolveSettings& settings, Extent render) {
  return bytes_of(render, PixelFormat::kR32F) + bytes_of(render, settings.velocity);
}

std::uint64_t quincunx_bytes(const ResolvePlan& plan, Extent render, Extent previous_render) {
  const std::uint64_t reactive = plan.reads_reactive ? bytes_of(render, PixelFormat::kR8) : 0;
  return read_of_frame(plan, render) + read_of_frame(plan, previous_render) + reactive +
         bytes_of(plan.settings.output, plan.settings.resolved);
}

std::uint64_t present_bytes(const ResolveSettings& settings) {
  return bytes_of(settings.output, settings.resolved) + bytes_of(settings.output, PixelFormat::kRGBA8);
}

}  // namespace quincunx
