// SPDX-License-Identifier: MIT
#include "quincunx/image.h"

#include <utility>

namespace quincunx {

std::size_t bytes_per_pixel(PixelFormat format) {
  switch (format) {
    case PixelFormat::kNone:
      return 0;
    case PixelFormat::kR8:
      return 1;
    case PixelFormat::kR32F:
    case PixelFormat::kRG16F:
    case PixelFormat::kRGBA8:
      return 4;
    case PixelFormat::kRG32F:
    case PixelFormat::kRGBA16F:
      return 8;
    case PixelFormat::kRGBA32F:
      return 16;
  }
  return 0;
}

const char* name_of(PixelFormat format) {
  switch (format) {
    case PixelFormat::kNone:
      return "none";
    case PixelFormat::kR8:
      return "R8";
    case PixelFormat::kR32F:
      return "R32F";
    case PixelFormat::kRG16F:
      return "RG16F";
    case PixelFormat::kRG32F:
      return "RG32F";
    case PixelFormat::kRGBA8:
      return "RGBA8";
    case PixelFormat::kRGBA16F:
      return "RGBA16F";
    case PixelFormat::kRGBA32F:
      return "RGBA32F";
  }
  return "unknown";
}

Image::~Image() {
  if (view_.memory != nullptr) clReleaseMemObject(view_.memory);
}

Image::Image(Image&& other) noexcept : view_(std::exchange(other.view_, {})) {}

Image& Image::operator=(Image&& other) noexcept {
  std::swap(view_, other.view_);
  return *this;
}

Image Image::adopt(const ImageView& view) {
  Image image;
  image.view_ = view;
  return image;
}

Image Image::borrow(const ImageView& view) {
  if (view.memory != nullptr) clRetainMemObject(view.memory);
  return adopt(view);
}

}  // namespace quincunx
