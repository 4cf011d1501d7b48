// SPDX-License-Identifier: MIT
#include "quincunx/image.h"

#include <array>
#include <utility>

namespace quincunx {

namespace {

struct FormatFacts {
  const char* name;
  std::size_t bytes;
  int channels;
};

// In the order of the enumerators.
constexpr std::array<FormatFacts, 8> kFormats = {{{"none", 0, 0},
                                                  {"R8", 1, 1},
                                                  {"R32F", 4, 1},
                                                  {"RG16F", 4, 2},
                                                  {"RG32F", 8, 2},
                                                  {"RGBA8", 4, 4},
                                                  {"RGBA16F", 8, 4},
                                                  {"RGBA32F", 16, 4}}};

const FormatFacts& facts_of(PixelFormat format) {
  static constexpr FormatFacts kUnknown = {"unknown", 0, 0};
  const auto at = static_cast<std::size_t>(format);
  return at < kFormats.size() ? kFormats[at] : kUnknown;
}

}  // namespace

std::size_t bytes_per_pixel(PixelFormat format) {
  return facts_of(format).bytes;
}

int channels_of(PixelFormat format) {
  return facts_of(format).channels;
}

const char* name_of(PixelFormat format) {
  return facts_of(format).name;
}

Image::~Image() {
  if (view_.memory != nullptr) clReleaseMemObject(view_.memory);
}

Image::Image(Image&& other) noexcept : view_(std::exchange(other.view_, {})) {}

Image& Image::operator=(Image&& other) noexcept {
  Image incoming(std::move(other));
  std::swap(view_, incoming.view_);  // what this one held ends as `incoming`
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
