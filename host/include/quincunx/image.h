// SPDX-License-Identifier: MIT
// Images, which passes read and write.
//
// A view names a rectangle of texels inside an OpenCL allocation: (allocation, byte offset, pitch, extent,
// format). The same kernels serve a viewport inside a larger target and a tightly packed image, by other
// numbers. Rows run top-down, x to the right; texel (x, y) has its centre at (x + .5, y + .5).
#pragma once

#include <CL/cl.h>

#include <cstddef>
#include <cstdint>

#include "quincunx/advanced/export.h"
#include "quincunx/advanced/extent.h"

namespace quincunx {

// Colour formats are linear light with premultiplied alpha. kRGBA8 is sRGB encoded: the linear light that the screen
// shows, premultiplied, then each colour encoded by IEC 61966-2-1; alpha is not.
enum class PixelFormat : std::uint8_t {
  kNone = 0,
  kR8,       // unsigned normalised: reactive values
  kR32F,     // depth
  kRG16F,    // velocity
  kRG32F,    // velocity
  kRGBA8,    // presented picture; colour
  kRGBA16F,  // colour
  kRGBA32F,  // colour
};

QUINCUNX_API std::size_t bytes_per_pixel(PixelFormat format);  // 0 for kNone
QUINCUNX_API int channels_of(PixelFormat format);              // 0 for kNone
QUINCUNX_API const char* name_of(PixelFormat format);          // "RGBA16F"

enum class Storage : std::uint8_t {
  kBuffer,  // cl_mem is a buffer; rows are `pitch` bytes apart
  kImage,   // cl_mem is an image2d_t; offset and pitch are zero
};

// A view of memory that belongs to someone else. `extent` is the allocated size (the *target* extent), of which a frame
// uses the top left part (the *render* extent, in FrameInputs). A device without two-channel images holds RG formats of
// image storage in four channels; the format still says RG. A buffer's image must end within the first 2^31 channels of
// its buffer (8 GiB of RGBA32F), as kernels count those in 32 bits.
struct ImageView {
  cl_mem memory = nullptr;
  Storage storage = Storage::kBuffer;
  PixelFormat format = PixelFormat::kNone;
  Extent extent = {};
  std::size_t offset = 0;  // bytes from the start of the buffer to texel (0, 0); a multiple of 16
  std::size_t pitch = 0;   // bytes from one row to the next; a multiple of the texel size; 0: tightly packed

  explicit operator bool() const { return memory != nullptr; }
  std::size_t row_pitch() const { return pitch != 0 ? pitch : extent.width * bytes_per_pixel(format); }
};

// Owns one OpenCL memory object and the view of the whole of it. Move-only. It may be released while a kernel that
// uses it is queued: OpenCL keeps the memory until the kernel has run. Threads that share one need a lock.
class QUINCUNX_API Image {
 public:
  Image() = default;
  ~Image();
  Image(Image&& other) noexcept;
  Image& operator=(Image&& other) noexcept;
  Image(const Image&) = delete;
  Image& operator=(const Image&) = delete;

  static Image adopt(const ImageView& view);   // takes over the caller's reference
  static Image borrow(const ImageView& view);  // adds a reference of its own

  const ImageView& view() const { return view_; }
  explicit operator bool() const { return view_.memory != nullptr; }

 private:
  ImageView view_;
};

}  // namespace quincunx
