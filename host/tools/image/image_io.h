// SPDX-License-Identifier: MIT
// Image files: with image_reader.h the only door to OpenEXR and libpng.
//
// Files are written under a temporary name and renamed, so nothing half-written stays; missing folders are
// made. Rows run top-down, as everywhere in Quincunx. All functions are thread-safe for different paths.
// Every error is kIoFailure (or kInvalidArgument for a bad argument), with one sentence that names the file
// and the reason.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "quincunx/image.h"
#include "quincunx/status.h"

namespace quincunx::tools {

enum class PngAlpha : std::uint8_t {
  kOpaque,  // RGB: alpha is left out
  kKeep,    // RGBA, straight (not premultiplied) as PNG has it
};

// Writes `extent` RGBA texels of 8 bits, sRGB encoded and tagged as such. `row_bytes` 0: tightly packed. The
// compression is fast rather than small: about 35 ms for 1280x720 on one core.
Status write_png(const std::string& path, Extent extent, const std::uint8_t* rgba, std::size_t row_bytes = 0,
                 PngAlpha alpha = PngAlpha::kOpaque);

// The bytes of a PNG with 1 (grey) or 3 (RGB) channels of 8 bits, as small as they get: slow. Errors:
// kInvalidArgument for another number of channels or a wrong count of texels.
Result<std::vector<std::uint8_t>> encode_png(Extent extent, int channels,
                                             std::span<const std::uint8_t> texels);

enum class ChannelType : std::uint8_t { kHalf, kFloat };

// One channel of an image in memory. `pixel_stride` and `row_stride` are bytes; 0: that of a packed plane.
// The data is converted where `stored` differs from `type`; it stays the caller's.
struct Channel {
  std::string name;                       // "R", "backward.u", "reactive.mask"
  ChannelType type = ChannelType::kHalf;  // type of the data in memory
  const void* data = nullptr;
  std::size_t pixel_stride = 0;
  std::size_t row_stride = 0;
  ChannelType stored = ChannelType::kHalf;  // in the file
};

struct Rational {
  int numerator = 0;
  int denominator = 1;

  friend bool operator==(const Rational&, const Rational&) = default;
};

// A matrix holds 16 floats in memory order of both glm (column vectors, column-major) and OpenEXR (row
// vectors, row-major), which is the same order.
using Matrix = std::array<float, 16>;
// x and y of red, green, blue and white: the standard attribute `chromaticities`.
using Chromaticities = std::array<float, 8>;
using AttributeValue = std::variant<std::string, int, float, Vec2, Rational, Matrix, Chromaticities>;

struct Attribute {
  std::string name;  // "quincunx:jitter", "worldToCamera", "FramesPerSecond"
  AttributeValue value;
};

// Writes a single-part EXR, ZIP compressed, data window = display window = extent, channels in the order
// given. Errors also: no channel, a channel without a name or data, two channels of one name.
Status write_exr(const std::string& path, Extent extent, std::span<const Channel> channels,
                 std::span<const Attribute> attributes = {});

struct LoadedImage {
  Extent extent;
  std::vector<std::string> channels;
  std::vector<ChannelType> stored;  // type of each channel in the file; kFloat for integer files
  std::vector<float> pixels;  // interleaved, extent.area() * channels.size(); 8-bit files: 0 to 1, as encoded
  std::vector<Attribute> attributes;  // an EXR's, of a type that AttributeValue holds

  int channel(std::string_view name) const;  // index, or -1
  float at(int x, int y, int channel) const {
    return pixels[(static_cast<std::size_t>(y) * extent.width + x) * channels.size() + channel];
  }
  const Attribute* attribute(std::string_view name) const;  // null when there is none
};

// Reads a whole image: a PNG by its name, else an EXR; the display window of its first part where it has several.
Result<LoadedImage> read_image(const std::string& path);

}  // namespace quincunx::tools
