// SPDX-License-Identifier: MIT
#include "frame_check.h"

#include <fmt/format.h>

namespace quincunx {
namespace {

constexpr std::size_t kLargestPitch = std::size_t{1} << 30;

const char* name(Storage storage) {
  return storage == Storage::kImage ? "image" : "buffer";
}

}  // namespace

void FrameCheck::input(const char* field, const ImageView& image, PixelFormat format, Extent viewport) {
  image_in(field, image, format, plan_.settings.storage);
  if (image && plan_.settings.targets == Targets::kPlaced && image.extent != viewport) {
    complain(fmt::format("{}.extent is {}x{}; placed targets have exactly the viewport's {}x{}", field,
                         image.extent.width, image.extent.height, viewport.width, viewport.height));
  } else if (image && (image.extent.width < viewport.width || image.extent.height < viewport.height)) {
    complain(fmt::format("{}.extent is {}x{}; it must hold the viewport of {}x{}", field, image.extent.width,
                         image.extent.height, viewport.width, viewport.height));
  }
}

void FrameCheck::viewport(const char* field, Extent viewport, Extent target) {
  if (viewport.width >= 1 && viewport.height >= 1 && viewport.width <= target.width &&
      viewport.height <= target.height) {
    return;
  }
  complain(fmt::format("{} is {}x{}; it must lie within 1x1 and the target's {}x{}", field, viewport.width,
                       viewport.height, target.width, target.height));
}

void FrameCheck::output(const char* field, const ImageView& image, PixelFormat format, Storage storage,
                        Extent extent, const char* whose) {
  image_in(field, image, format, storage);
  if (image && image.extent != extent) {
    complain(fmt::format("{}.extent is {}x{}; it must be the {}'s {}x{}", field, image.extent.width,
                         image.extent.height, whose, extent.width, extent.height));
  }
}

void FrameCheck::finite(const char* field, float value, float low, float high) {
  if (value >= low && value <= high) return;
  complain(fmt::format("{} is {}; it must lie in [{}, {}]", field, value, low, high));
}

void FrameCheck::image_in(const char* field, const ImageView& image, PixelFormat format, Storage storage) {
  if (!image) {
    complain(fmt::format("{} is missing; the plan needs it as {}", field, name_of(format)));
    return;
  }
  if (image.format != format) {
    complain(fmt::format("{}.format is {}; the plan has {}", field, name_of(image.format), name_of(format)));
  }
  if (image.storage != storage) {
    complain(fmt::format("{}.storage is {}; the plan has {}", field, name(image.storage), name(storage)));
  }
  if (image.storage == Storage::kBuffer) layout(field, image);
}

void FrameCheck::layout(const char* field, const ImageView& image) {
  const std::size_t texel = bytes_per_pixel(image.format);
  const std::size_t row = static_cast<std::size_t>(image.extent.width) * texel;
  if (texel != 0 && image.pitch != 0 && (image.pitch < row || image.pitch % texel != 0)) {
    complain(fmt::format("{}.pitch is {}; it must be a multiple of {} and at least {}", field, image.pitch,
                         texel, row));
  }
  if (image.offset % 16 != 0) {
    complain(fmt::format("{}.offset is {}; it must be a multiple of 16", field, image.offset));
  }
  if (image.pitch > kLargestPitch) {
    complain(fmt::format("{}.pitch is {}; it must be at most {}", field, image.pitch, kLargestPitch));
  }
}

}  // namespace quincunx
