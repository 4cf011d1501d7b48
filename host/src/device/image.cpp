// SPDX-License-Identifier: MIT
#include "quincunx/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "device/device_impl.h"

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

Status check_copy(const ImageView& image, Extent extent, const void* texels, std::size_t row_bytes) {
  if (!image) return Status::invalid("the image is empty; it needs an allocation");
  if (extent.width < 1 || extent.height < 1 || extent.width > image.extent.width ||
      extent.height > image.extent.height) {
    return Status::invalid(fmt::format("extent is {}x{}; it must lie within 1x1 and the image's {}x{}",
                                       extent.width, extent.height, image.extent.width, image.extent.height));
  }
  if (texels == nullptr) {
    return Status::invalid(fmt::format("texels is null; it must point to {}x{} texels of {}", extent.width,
                                       extent.height, name_of(image.format)));
  }
  const std::size_t row = static_cast<std::size_t>(extent.width) * bytes_per_pixel(image.format);
  if (row_bytes != 0 && row_bytes < row) {
    return Status::invalid(
        fmt::format("row_bytes is {}; it must be 0 or at least the {} of a row", row_bytes, row));
  }
  return {};
}

// Bytes of a texel as the device holds it: an RG image may be a four-channel one.
std::size_t device_texel_bytes(const ImageView& image) {
  if (image.storage == Storage::kBuffer) return bytes_per_pixel(image.format);
  std::size_t bytes = 0;
  if (clGetImageInfo(image.memory, CL_IMAGE_ELEMENT_SIZE, sizeof(bytes), &bytes, nullptr) != CL_SUCCESS)
    return 0;
  return bytes;
}

enum class Direction { kUpload, kDownload };

void copy_rows(const cl::CommandQueue& queue, Direction direction, const ImageView& image, std::size_t first,
               std::size_t rows, int width, void* texels, std::size_t row_bytes) {
  const auto columns = static_cast<std::size_t>(width);
  if (image.storage == Storage::kImage) {
    const auto memory = borrow<cl::Image2D>(image.memory);
    const std::array<cl::size_type, 3> origin = {0, first, 0};
    const std::array<cl::size_type, 3> region = {columns, rows, 1};
    if (direction == Direction::kUpload) {
      queue.enqueueWriteImage(memory, CL_TRUE, origin, region, row_bytes, 0, texels);
    } else {
      queue.enqueueReadImage(memory, CL_TRUE, origin, region, row_bytes, 0, texels);
    }
    return;
  }
  const auto memory = borrow<cl::Buffer>(image.memory);
  const std::size_t pitch = image.row_pitch();
  const std::array<cl::size_type, 3> zero = {0, 0, 0};
  const std::array<cl::size_type, 3> origin = {image.offset % pitch, image.offset / pitch + first, 0};
  const std::array<cl::size_type, 3> region = {columns * bytes_per_pixel(image.format), rows, 1};
  if (direction == Direction::kUpload) {
    queue.enqueueWriteBufferRect(memory, CL_TRUE, origin, zero, region, pitch, 0, row_bytes, 0, texels);
  } else {
    queue.enqueueReadBufferRect(memory, CL_TRUE, origin, zero, region, pitch, 0, row_bytes, 0, texels);
  }
}

// Rusticl of Mesa 25.0 takes the rows of a copy for tight where there are as many of them as a row has bytes, or texels
// of an image. Two copies of fewer rows each are right everywhere.
void copy_blocking(const cl::CommandQueue& queue, Direction direction, const ImageView& image, Extent extent,
                   void* texels, std::size_t row_bytes) {
  const auto rows = static_cast<std::size_t>(extent.height);
  const std::size_t unit = image.storage == Storage::kImage ? device_texel_bytes(image) : 1;
  const std::size_t last = rows > 1 && rows * unit == row_bytes ? 1 : 0;
  copy_rows(queue, direction, image, 0, rows - last, extent.width, texels, row_bytes);
  if (last == 0) return;
  copy_rows(queue, direction, image, rows - 1, 1, extent.width,
            static_cast<std::byte*>(texels) + (rows - 1) * row_bytes, row_bytes);
}

// Copies rows of texels of different size: host texels and the wider ones of an image that stands in for RG.
void repack(const std::byte* from, std::size_t from_row, std::size_t from_texel, std::byte* to,
            std::size_t to_row, std::size_t to_texel, Extent extent) {
  const std::size_t common = std::min(from_texel, to_texel);
  for (int y = 0; y < extent.height; ++y) {
    for (int x = 0; x < extent.width; ++x) {
      std::copy_n(from + y * from_row + x * from_texel, common, to + y * to_row + x * to_texel);
    }
  }
}

// Copies between the host's texels and the image's, which may be wider.
Status copy(const Device::Impl& impl, Direction direction, const ImageView& image, Extent extent,
            void* texels, std::size_t row_bytes) {
  if (Status status = check_copy(image, extent, texels, row_bytes); !status.ok()) return status;
  const bool is_upload = direction == Direction::kUpload;
  const std::size_t texel = bytes_per_pixel(image.format), wide = device_texel_bytes(image);
  const std::size_t host_row = row_bytes != 0 ? row_bytes : extent.width * texel, row = extent.width * wide;
  try {
    if (wide == texel) {
      copy_blocking(impl.queue, direction, image, extent, texels, host_row);
      return {};
    }
    auto* const host = static_cast<std::byte*>(texels);
    std::vector<std::byte> staged(static_cast<std::size_t>(extent.area()) * wide);
    if (is_upload) repack(host, host_row, texel, staged.data(), row, wide, extent);
    copy_blocking(impl.queue, direction, image, extent, staged.data(), row);
    if (!is_upload) repack(staged.data(), row, wide, host, host_row, texel, extent);
    return {};
  } catch (...) {
    return caught(is_upload ? "upload" : "download", impl.info.name);
  }
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

Status Device::upload(const ImageView& image, Extent extent, const void* texels,
                      std::size_t row_bytes) const {
  return copy(*impl_, Direction::kUpload, image, extent, const_cast<void*>(texels), row_bytes);
}

Status Device::download(const ImageView& image, Extent extent, void* texels, std::size_t row_bytes) const {
  return copy(*impl_, Direction::kDownload, image, extent, texels, row_bytes);
}

}  // namespace quincunx
