// SPDX-License-Identifier: MIT
#include "tools/image/image_io.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <exception>
#include <filesystem>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "tools/image/image_attributes.h"
#include "tools/image/image_reader.h"
#include "tools/program/atomic_file.h"

namespace quincunx::tools {

namespace {

// How a PNG is written. The frame loop waits for files: level 1 out of 9, and one filter, which is 2.5 times faster
// than trying all and no larger.
struct PngWay {
  int level = 1;
  int filters = PNG_FILTER_UP;
};
constexpr PngWay kSmallest = {9, PNG_ALL_FILTERS};

Status cannot_write(const std::string& path, const std::string& reason) {
  return Status::io(fmt::format("'{}' cannot be written: {}", path, reason));
}

Status cannot_decode(const std::string& path, const std::string& reason) {
  return Status::io(fmt::format("'{}' cannot be read: {}", path, reason));
}

Status check_extent(const std::string& path, Extent extent) {
  if (extent.width >= 1 && extent.height >= 1) return {};
  return Status::invalid(
      fmt::format("'{}': an image of {}x{} pixels cannot be written; each side must be at "
                  "least 1",
                  path, extent.width, extent.height));
}

struct PngRows {
  Extent extent;
  int channels = 3;  // in the file: 1 grey, 3 RGB, 4 RGBA
  const std::uint8_t* texels = nullptr;
  std::size_t row_bytes = 0;
  bool skips_fourth = false;  // of each texel in memory
};

void append(png_structp png, png_bytep bytes, std::size_t count) {
  auto& made = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  made.insert(made.end(), bytes, bytes + count);
}

// False where libpng refuses: it then jumps back here, so nothing in this function may have a destructor.
bool write_rows(png_structp png, png_infop info, const PngRows& rows, const PngWay& way) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  constexpr int kColourTypes[] = {0, PNG_COLOR_TYPE_GRAY, 0, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
  png_set_IHDR(png, info, static_cast<png_uint_32>(rows.extent.width),
               static_cast<png_uint_32>(rows.extent.height), 8, kColourTypes[rows.channels],
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_compression_level(png, way.level);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, way.filters);
  png_write_info(png, info);
  if (rows.skips_fourth) png_set_filler(png, 0, PNG_FILLER_AFTER);
  for (int y = 0; y < rows.extent.height; ++y)
    png_write_row(png, rows.texels + static_cast<std::size_t>(y) * rows.row_bytes);
  png_write_end(png, info);
  return true;
}

// Empty where libpng refuses, which says why on stderr: too long a side, or no memory.
std::vector<std::uint8_t> encoded(const PngRows& rows, const PngWay& way) {
  std::vector<std::uint8_t> made;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info != nullptr) {
    png_set_write_fn(png, &made, append, nullptr);
    if (!write_rows(png, info, rows, way)) made.clear();
  }
  png_destroy_write_struct(&png, &info);
  return made;
}

Status write_bytes(const std::string& path, const void* bytes, std::size_t count) {
  return write_text(path, {static_cast<const char*>(bytes), count});
}

std::size_t size_of(ChannelType type) {
  return type == ChannelType::kHalf ? sizeof(half) : sizeof(float);
}

Imf::PixelType type_of(ChannelType type) {
  return type == ChannelType::kHalf ? Imf::HALF : Imf::FLOAT;
}

Status check_channels(const std::string& path, std::span<const Channel> channels) {
  if (channels.empty()) return Status::invalid(fmt::format("'{}': there is no channel to write", path));
  std::set<std::string_view> names;
  for (const Channel& channel : channels) {
    if (channel.name.empty()) return Status::invalid(fmt::format("'{}': a channel has no name", path));
    if (channel.data == nullptr) {
      return Status::invalid(fmt::format("'{}': channel '{}' has no data", path, channel.name));
    }
    if (!names.insert(channel.name).second) {
      return Status::invalid(fmt::format("'{}': channel '{}' is there twice", path, channel.name));
    }
  }
  return {};
}

// The channel's texels as a packed plane of the type that the file stores.
template <typename From, typename To>
std::vector<char> converted(const Channel& channel, Extent extent, std::size_t pixel_stride,
                            std::size_t row_stride) {
  std::vector<char> plane(static_cast<std::size_t>(extent.area()) * sizeof(To));
  char* to = plane.data();
  for (int y = 0; y < extent.height; ++y) {
    const char* from = static_cast<const char*>(channel.data) + static_cast<std::size_t>(y) * row_stride;
    for (int x = 0; x < extent.width; ++x, from += pixel_stride, to += sizeof(To)) {
      From value;
      std::memcpy(&value, from, sizeof value);
      const To stored(value);
      std::memcpy(to, &stored, sizeof stored);
    }
  }
  return plane;
}

void write_channels(Imf::OutputFile& file, Extent extent, std::span<const Channel> channels) {
  Imf::FrameBuffer buffer;
  std::vector<std::vector<char>> planes;
  for (const Channel& channel : channels) {
    std::size_t pixel_stride = channel.pixel_stride != 0 ? channel.pixel_stride : size_of(channel.type);
    std::size_t row_stride = channel.row_stride != 0 ? channel.row_stride : pixel_stride * extent.width;
    char* data = static_cast<char*>(const_cast<void*>(channel.data));  // which is only read
    if (channel.type != channel.stored) {
      planes.push_back(channel.stored == ChannelType::kHalf
                           ? converted<float, half>(channel, extent, pixel_stride, row_stride)
                           : converted<half, float>(channel, extent, pixel_stride, row_stride));
      data = planes.back().data();
      pixel_stride = size_of(channel.stored);
      row_stride = pixel_stride * extent.width;
    }
    buffer.insert(channel.name, Imf::Slice(type_of(channel.stored), data, pixel_stride, row_stride));
  }
  file.setFrameBuffer(buffer);
  file.writePixels(extent.height);
}

Result<LoadedImage> read_png(const std::string& path) {
  png_image file = {};
  file.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&file, path.c_str()) == 0) return cannot_decode(path, file.message);
  file.format &= PNG_FORMAT_FLAG_ALPHA | PNG_FORMAT_FLAG_COLOR;  // 8 bits, in that order
  std::vector<std::uint8_t> texels(PNG_IMAGE_SIZE(file));
  if (png_image_finish_read(&file, nullptr, texels.data(), 0, nullptr) == 0)
    return cannot_decode(path, file.message);
  LoadedImage image;
  image.extent = {static_cast<int>(file.width), static_cast<int>(file.height)};
  image.channels = (file.format & PNG_FORMAT_FLAG_COLOR) != 0 ? std::vector<std::string>{"R", "G", "B"}
                                                              : std::vector<std::string>{"Y"};
  if ((file.format & PNG_FORMAT_FLAG_ALPHA) != 0) image.channels.emplace_back("A");
  image.stored.assign(image.channels.size(), ChannelType::kFloat);
  for (const std::uint8_t code : texels)
    image.pixels.push_back(static_cast<float>(code) / 255);
  return image;
}

Result<LoadedImage> read_exr(const std::string& path) {
  auto reader = ImageReader::open(path);
  if (!reader.ok()) return reader.status();
  const ImagePart& part = reader->header().parts.front();
  if (part.deep) return cannot_decode(path, "it holds deep pixels; a flat image is needed");
  LoadedImage image = {.extent = part.display.extent,
                       .channels = {},
                       .stored = {},
                       .pixels = {},
                       .attributes = reader->header().attributes};
  const std::size_t count = part.channels.size();
  image.pixels.resize(static_cast<std::size_t>(image.extent.area()) * count);
  std::vector<ChannelTarget> targets;
  for (const HeaderChannel& channel : part.channels) {
    image.channels.push_back(channel.name);
    image.stored.push_back(channel.stored);
    const std::size_t index = targets.size();
    targets.push_back({.from = {0, static_cast<int>(index)},
                       .type = ChannelType::kFloat,
                       .data = image.pixels.data() + index,
                       .pixel_stride = count * sizeof(float),
                       .row_stride = count * sizeof(float) * image.extent.width});
  }
  if (Status status = reader->read(targets); !status.ok()) return status;
  return image;
}

}  // namespace

Status write_png(const std::string& path, Extent extent, const std::uint8_t* rgba, std::size_t row_bytes,
                 PngAlpha alpha) {
  if (Status status = check_extent(path, extent); !status.ok()) return status;
  if (rgba == nullptr) return Status::invalid(fmt::format("'{}': there are no texels to write", path));
  const bool keeps = alpha == PngAlpha::kKeep;
  const std::size_t row = row_bytes != 0 ? row_bytes : static_cast<std::size_t>(extent.width) * 4;
  const std::vector<std::uint8_t> bytes = encoded({extent, keeps ? 4 : 3, rgba, row, !keeps}, {});
  if (bytes.empty()) return cannot_write(path, "it cannot be encoded");
  return write_bytes(path, bytes.data(), bytes.size());
}

Result<std::vector<std::uint8_t>> encode_png(Extent extent, int channels,
                                             std::span<const std::uint8_t> texels) {
  if (Status status = check_extent("PNG", extent); !status.ok()) return status;
  if ((channels != 1 && channels != 3) ||
      texels.size() != static_cast<std::size_t>(extent.area()) * static_cast<std::size_t>(channels)) {
    return Status::invalid(fmt::format("a PNG of {}x{} pixels cannot be made from {} texels of {} channels",
                                       extent.width, extent.height, texels.size(), channels));
  }
  std::vector<std::uint8_t> bytes =
      encoded({.extent = extent,
               .channels = channels,
               .texels = texels.data(),
               .row_bytes = static_cast<std::size_t>(extent.width) * static_cast<std::size_t>(channels)},
              kSmallest);
  if (bytes.empty()) return cannot_write("PNG", "it cannot be encoded");
  return bytes;
}

Status write_exr(const std::string& path, Extent extent, std::span<const Channel> channels,
                 std::span<const Attribute> attributes) {
  if (Status status = check_extent(path, extent); !status.ok()) return status;
  if (Status status = check_channels(path, channels); !status.ok()) return status;
  Imf::StdOSStream memory;  // the file's own stream would not tell of a full disk
  try {
    Imf::Header header(extent.width, extent.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const Channel& channel : channels)
      header.channels().insert(channel.name, Imf::Channel(type_of(channel.stored)));
    set_attributes(header, attributes);
    Imf::OutputFile file(memory, header);
    write_channels(file, extent, channels);
  } catch (const std::exception& problem) {
    return cannot_write(path, problem.what());
  }
  const std::string bytes = memory.str();
  return write_bytes(path, bytes.data(), bytes.size());
}

int LoadedImage::channel(std::string_view name) const {
  const auto found = std::find(channels.begin(), channels.end(), name);
  return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
}

const Attribute* LoadedImage::attribute(std::string_view name) const {
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [&](const Attribute& attribute) { return attribute.name == name; });
  return found == attributes.end() ? nullptr : &*found;
}

Result<LoadedImage> read_image(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error) && path.ends_with(".png")) return read_png(path);
  return read_exr(path);
}

}  // namespace quincunx::tools
