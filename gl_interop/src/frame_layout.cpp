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
