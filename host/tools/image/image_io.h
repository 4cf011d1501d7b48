// SPDX-License-Identifier: MIT
// Image files: with image_reader.h the only door to them.
//
// Two files implement both headers, and each program links one of them. image_openimageio.cpp knows every format of
// OpenImageIO. image_openexr.cpp knows EXR and PNG, by OpenEXR and libpng, for programs that carry their libraries with
// them. image_io.cpp is what they have in common.
//
// Files are written under a temporary name and renamed, so nothing half-written stays; missing folders are
// made. Rows run top-down, as everywhere in Quincunx. All functions are thread-safe for different paths.
// Every error is kIoFailure (or kInvalidArgument for a bad argument), with one sentence that names the file
// and the reason.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "quincunx/advanced/method.h"
#include "quincunx/image.h"
#include "quincunx/status.h"
#include "tools/program/frame_pattern.h"

namespace quincunx::tools {

enum class FileFormat : std::uint8_t { kExr, kTiff, kHdr, kPng, kJpeg, kDpx };

// Returns the format that a path's ending names, in any case of letters; nothing for one that cannot be written.
std::optional<FileFormat> format_of(std::string_view path);
std::string endings();  // those that can be written: ".exr, .tif, .hdr, .png, .jpg or .dpx"

// Reads the pattern of files to write. Errors: as of FramePattern::parse(), and for an ending that cannot be written.
Result<FramePattern> output_pattern(const std::string& text);
inline FileFormat format_of(const FramePattern& output) {
  return format_of(output.text()).value_or(FileFormat::kExr);
}

// Whether frames are linear light in files of this format: half or float in an EXR, float in a TIFF, RGBE in an HDR.
// The others hold the picture as displayed, sRGB encoded: 8 bits in PNG and JPEG, 10 in DPX.
constexpr bool holds_light(FileFormat format) {
  return format <= FileFormat::kHdr;
}
constexpr bool has_8_bits(FileFormat format) {
  return format == FileFormat::kPng || format == FileFormat::kJpeg;
}

struct Attribute;

enum class Alpha : std::uint8_t {
  kOpaque,  // RGB: alpha is left out
  kKeep,    // RGBA, straight (not premultiplied) as PNG has it
};

// Returns why write_picture() cannot make a file of this name, in one sentence; empty where it can.
std::string no_picture(const std::string& path);

// Writes `extent` RGBA texels of 8 bits, sRGB encoded and tagged as such, as PNG, JPEG, DPX or TIFF. `row_bytes` 0:
// tightly packed. Compression is fast rather than small: a PNG of 1280x720 takes about 35 ms on one core.
Status write_picture(const std::string& path, Extent extent, const std::uint8_t* rgba,
                     std::size_t row_bytes = 0, Alpha alpha = Alpha::kOpaque,
                     std::span<const Attribute> attributes = {});

// The bytes of a PNG with 1 (grey) or 3 (RGB) channels of 8 bits, as small as they get: slow. Errors:
// kInvalidArgument for another number of channels or a wrong count of texels.
Result<std::vector<std::uint8_t>> encode_png(Extent extent, int channels,
                                             std::span<const std::uint8_t> texels);

enum class ChannelType : std::uint8_t { kHalf, kFloat };
inline constexpr float kLargestHalf = 65504;

constexpr std::size_t bytes_of(ChannelType type) {
  return type == ChannelType::kHalf ? 2 : 4;
}

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

// SMPTE 12M: two words as EXR and DPX have them.
struct TimeCode {
  std::uint32_t time = 0;  // binary coded hours, minutes, seconds and frames, with flags
  std::uint32_t user = 0;

  friend bool operator==(const TimeCode&, const TimeCode&) = default;
};

// A matrix holds 16 floats in memory order of both glm (column vectors, column-major) and OpenEXR (row
// vectors, row-major), which is the same order.
using Matrix = std::array<float, 16>;
// x and y of red, green, blue and white: the standard attribute `chromaticities`.
using Chromaticities = std::array<float, 8>;
using AttributeValue =
    std::variant<std::string, int, float, Vec2, Rational, Matrix, Chromaticities, TimeCode>;

// Every format's attributes have the names that EXR gives them.
struct Attribute {
  std::string name;  // "quincunx:jitter", "worldToCamera", "framesPerSecond", "owner", "timeCode"
  AttributeValue value;
};

// Whether any of the values is beyond the largest half.
bool exceed_halves(std::span<const float> values);

// Writes a single-part EXR, ZIP compressed, data window = display window = extent, channels in the order
// given. Errors also: no channel, a channel without a name or data, two channels of one name.
Status write_exr(const std::string& path, Extent extent, std::span<const Channel> channels,
                 std::span<const Attribute> attributes = {});

// How light becomes a picture as displayed.
struct Display {
  ToneMap tone_map = ToneMap::kClamp;
  float exposure = 1;
};

// Writes linear RGBA: `stored` in an EXR, as halves within the largest one; as holds_light() says in the others.
Status write_light(const std::string& path, Extent extent, std::span<const float> rgba,
                   ChannelType stored = ChannelType::kHalf, const Display& display = {},
                   std::span<const Attribute> attributes = {});

struct LoadedImage {
  Extent extent;
  std::vector<std::string> channels;
  std::vector<ChannelType> stored;  // type of each channel in the file; kFloat for integer files
  std::vector<float> pixels;  // interleaved, extent.area() * channels.size(); 8-bit files: 0 to 1, as encoded
  std::vector<Attribute> attributes;  // of a type that AttributeValue holds

  int channel(std::string_view name) const;  // index, or -1
  float at(int x, int y, int channel) const {
    return pixels[(static_cast<std::size_t>(y) * extent.width + x) * channels.size() + channel];
  }
  const Attribute* attribute(std::string_view name) const;  // null when there is none
};

// Reads a whole image, as encoded: the display window of its first part.
Result<LoadedImage> read_image(const std::string& path);

// What the library behind the headers does: makes a file's bytes. Arguments are checked; of an error's sentence the
// Status holds the reason alone.
namespace backend {

using Bytes = std::vector<std::uint8_t>;

struct Ending {
  std::string_view text;  // ".exr"; the first of a format is its usual one
  FileFormat format;
};
std::span<const Ending> written_endings();

enum class Depth : std::uint8_t { k8 = 1, k16 = 2, kFloat = 4 };  // bytes

// Interleaved texels: sRGB codes, or linear light where they are floats. The first `channels` of each go into the file.
struct Texels {
  Extent extent;
  int channels = 3;  // 1: grey, 3: RGB, 4: RGBA
  Depth depth = Depth::k8;
  const void* data = nullptr;
  std::size_t pixel_stride = 0;  // bytes
  std::size_t row_stride = 0;
  bool small = false;  // takes its time
};

Result<Bytes> encode(FileFormat format, const Texels& texels, std::span<const Attribute> attributes = {});
Result<Bytes> encode_exr(Extent extent, std::span<const Channel> channels,  // strides are set
                         std::span<const Attribute> attributes);

}  // namespace backend

}  // namespace quincunx::tools
