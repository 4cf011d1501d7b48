// SPDX-License-Identifier: MIT
#include "frame_layout.h"

namespace quincunx::gl {
namespace {

// Rows start on a cache line pair, which is also what PoCL's widest loads want.
constexpr std::size_t kRowAlignment = 128;
// Where buffers and images may begin inside of an allocation, on every device.
constexpr std::size_t kRegionAlignment = 4096;

std::size_t round_up(std::size_t value, std::size_t step) {
  return (value + step - 1) / step * step;
}

}  // namespace

GlFormat gl_format(PixelFormat format) {
  switch (format) {
    case PixelFormat::kR8:
      return {GL_R8, GL_RED, GL_UNSIGNED_BYTE};
    case PixelFormat::kR32F:
      return {GL_R32F, GL_RED, GL_FLOAT};
    case PixelFormat::kRG16F:
      return {GL_RG16F, GL_RG, GL_HALF_FLOAT};
    case PixelFormat::kRG32F:
      return {GL_RG32F, GL_RG, GL_FLOAT};
    case PixelFormat::kRGBA8:
      return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
    case PixelFormat::kRGBA16F:
      return {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT};
    case PixelFormat::kRGBA32F:
      return {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    case PixelFormat::kNone:
      break;
  }
  return {};
}

cl_image_format cl_format(PixelFormat format) {
  switch (format) {
    case PixelFormat::kR8:
      return {CL_R, CL_UNORM_INT8};
    case PixelFormat::kR32F:
      return {CL_R, CL_FLOAT};
    case PixelFormat::kRG16F:
      return {CL_RG, CL_HALF_FLOAT};
    case PixelFormat::kRG32F:
      return {CL_RG, CL_FLOAT};
    case PixelFormat::kRGBA8:
      return {CL_RGBA, CL_UNORM_INT8};
    case PixelFormat::kRGBA16F:
      return {CL_RGBA, CL_HALF_FLOAT};
    case PixelFormat::kRGBA32F:
      return {CL_RGBA, CL_FLOAT};
    case PixelFormat::kNone:
      break;
  }
  return {};
}

std::vector<Plane> planes_of(const BridgeSettings& settings) {
  std::vector<Plane> planes = {{PlaneKind::kColour, settings.colour, GL_COLOR_ATTACHMENT0}};
  if (settings.depth) planes.push_back({PlaneKind::kDepth, PixelFormat::kR32F, GL_DEPTH_ATTACHMENT});
  if (settings.velocity)
    planes.push_back({PlaneKind::kVelocity, settings.velocity_format, GL_COLOR_ATTACHMENT1});
  if (settings.reactive) planes.push_back({PlaneKind::kReactive, PixelFormat::kR8, GL_COLOR_ATTACHMENT2});
  return planes;
}

TargetNeeds target_needs(const BridgeSettings& settings) {
  return {.target_extent = settings.target_extent,
          .velocity = settings.velocity,
          .reactive = settings.reactive,
          .checkerboard = settings.checkerboard,
          .colour = settings.colour};
}

ImageView& view_of(SharedFrame& frame, PlaneKind kind) {
  switch (kind) {
    case PlaneKind::kDepth:
      return frame.depth;
    case PlaneKind::kVelocity:
      return frame.velocity;
    case PlaneKind::kReactive:
      return frame.reactive;
    case PlaneKind::kColour:
      break;
  }
  return frame.colour;
}

void place(ImageView& view, Extent render, int row_texels) {
  const std::size_t texels =
      round_up(static_cast<std::size_t>(render.width), static_cast<std::size_t>(row_texels));
  view.extent = render;
  view.pitch = texels * bytes_per_pixel(view.format);
}

FrameLayout lay_out(const std::vector<Plane>& planes, Extent target, Targets targets, int row_texels) {
  FrameLayout layout;
  for (const Plane& plane : planes) {
    ImageView& view = view_of(layout.views, plane.kind);
    view.format = plane.format;
    if (targets == Targets::kPlaced) {
      place(view, target, row_texels);
      view.offset = round_up(layout.bytes, kRegionAlignment);
    } else {
      view.extent = target;
      view.pitch = round_up(target.width * bytes_per_pixel(plane.format), kRowAlignment);
      view.offset = round_up(layout.bytes, view.pitch);  // a whole number of its own rows
    }
    layout.bytes = view.offset + view.pitch * static_cast<std::size_t>(target.height);
  }
  return layout;
}

}  // namespace quincunx::gl
