// SPDX-License-Identifier: MIT
#include "frame_layout.h"

#include <algorithm>

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

const FormatNames& names_of(PixelFormat format) {
  constexpr GLint kCodes = GL_UNSIGNED_NORMALIZED, kFloats = GL_FLOAT;
  static constexpr std::array<FormatNames, 8> kNames = {{
      {PixelFormat::kNone, {}, {}, {}, GL_NONE},
      {PixelFormat::kR8, {GL_R8, GL_RED, GL_UNSIGNED_BYTE}, {CL_R, CL_UNORM_INT8}, {8, 0, 0, 0}, kCodes},
      {PixelFormat::kR32F, {GL_R32F, GL_RED, GL_FLOAT}, {CL_R, CL_FLOAT}, {32, 0, 0, 0}, kFloats},
      {PixelFormat::kRG16F,
       {GL_RG16F, GL_RG, GL_HALF_FLOAT},
       {CL_RG, CL_HALF_FLOAT},
       {16, 16, 0, 0},
       kFloats},
      {PixelFormat::kRG32F, {GL_RG32F, GL_RG, GL_FLOAT}, {CL_RG, CL_FLOAT}, {32, 32, 0, 0}, kFloats},
      {PixelFormat::kRGBA8,
       {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE},
       {CL_RGBA, CL_UNORM_INT8},
       {8, 8, 8, 8},
       kCodes},
      {PixelFormat::kRGBA16F,
       {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT},
       {CL_RGBA, CL_HALF_FLOAT},
       {16, 16, 16, 16},
       kFloats},
      {PixelFormat::kRGBA32F,
       {GL_RGBA32F, GL_RGBA, GL_FLOAT},
       {CL_RGBA, CL_FLOAT},
       {32, 32, 32, 32},
       kFloats},
  }};
  return *std::find_if(kNames.begin(), kNames.end() - 1,
                       [&](const FormatNames& row) { return row.format == format; });
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

FrameLayout lay_out(std::vector<Plane> planes, Extent target, Targets targets, int row_texels) {
  // Kernels count a plane's texels by its channels, in 32 bits: the widest channels reach furthest, and lie last.
  std::stable_sort(planes.begin(), planes.end(), [](const Plane& a, const Plane& b) {
    return names_of(a.format).bits[0] < names_of(b.format).bits[0];
  });
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
