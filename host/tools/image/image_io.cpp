// SPDX-License-Identifier: MIT
#include "tools/image/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "tools/image/image_attributes.h"
#include "tools/program/atomic_file.h"

namespace quincunx::tools {

namespace {

constexpr int kPngCompressionLevel = 1;  // level 1 out of 9: the frame loop waits for it
constexpr int kPngFilterUp = 0x20;  // libpng's PNG_FILTER_UP: 2.5 times faster than trying all, no larger
constexpr int kPngSmallest = 9;
constexpr int kPngFilterAll = 0xf8;      // libpng's PNG_ALL_FILTERS: the best of five for each row
constexpr int kZipCompressionLevel = 4;  // OpenEXR's own default

// OpenImageIO's messages may run over several lines and repeat the temporary name; one sentence is enough.
std::string first_line(std::string text) {
  const std::size_t end = text.find('\n');
  if (end != std::string::npos) text.resize(end);
  return text.empty() ? "no reason was given" : text;
}

Status cannot_write(const std::string& path, const std::string& reason) {
  return Status::io(fmt::format("'{}' cannot be written: {}", path, first_line(reason)));
}

Status cannot_read(const std::string& path, const std::string& reason) {
  return Status::io(fmt::format("'{}' cannot be read: {}", path, first_line(reason)));
}

Status check_extent(const std::string& path, Extent extent) {
  if (extent.width >= 1 && extent.height >= 1) return {};
  return Status::invalid(
      fmt::format("'{}': an image of {}x{} pixels cannot be written; each side must be at "
                  "least 1",
                  path, extent.width, extent.height));
}

// Opens the temporary file with the format's own writer, since its name does not tell the format.
Status write_whole(const std::string& path, const char* format, const OIIO::ImageSpec& spec,
                   OIIO::TypeDesc type, const void* data, OIIO::stride_t pixel_stride,
                   OIIO::stride_t row_stride) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file.ok()) return file.status();
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
  if (!output) return cannot_write(path, OIIO::geterror());
  if (!output->open(file->temporary_path(), spec)) return cannot_write(path, output->geterror());
  if (!output->write_image(type, data, pixel_stride, row_stride))
    return cannot_write(path, output->geterror());
  if (!output->close()) return cannot_write(path, output->geterror());
  return file->commit();
}

std::size_t size_of(ChannelType type) {
  return type == ChannelType::kHalf ? 2 : 4;
}

OIIO::TypeDesc type_of(ChannelType type) {
  return type == ChannelType::kHalf ? OIIO::TypeHalf : OIIO::TypeFloat;
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

// One interleaved row-major buffer of the file's own types, as OpenImageIO's writer takes mixed types.
Result<std::vector<std::byte>> interleave(const std::string& path, Extent extent,
                                          std::span<const Channel> channels, std::size_t pixel_bytes) {
  std::vector<std::byte> native(static_cast<std::size_t>(extent.area()) * pixel_bytes);
  std::size_t offset = 0;
  for (const Channel& channel : channels) {
    const std::size_t pixel_stride = channel.pixel_stride != 0 ? channel.pixel_stride : size_of(channel.type);
    const std::size_t row_stride = channel.row_stride != 0 ? channel.row_stride : pixel_stride * extent.width;
    const bool converted = OIIO::convert_image(
        1, extent.width, extent.height, 1, channel.data, type_of(channel.type),
        static_cast<OIIO::stride_t>(pixel_stride), static_cast<OIIO::stride_t>(row_stride), OIIO::AutoStride,
        native.data() + offset, type_of(channel.stored), static_cast<OIIO::stride_t>(pixel_bytes),
        static_cast<OIIO::stride_t>(pixel_bytes * extent.width), OIIO::AutoStride);
    if (!converted) return cannot_write(path, fmt::format("channel '{}' cannot be converted", channel.name));
    offset += size_of(channel.stored);
  }
  return native;
}

LoadedImage describe(const OIIO::ImageSpec& spec) {
  LoadedImage image;
  image.extent = {spec.width, spec.height};
  image.channels = spec.channelnames;
  for (int i = 0; i < spec.nchannels; ++i) {
    image.stored.push_back(spec.channelformat(i) == OIIO::TypeHalf ? ChannelType::kHalf
                                                                   : ChannelType::kFloat);
  }
  image.attributes = attributes_of(spec);
  return image;
}

Result<LoadedImage> read_unguarded(const std::string& path) {
  OIIO::ImageSpec as_stored;  // no premultiplication of PNG's encoded colours
  as_stored.attribute("oiio:UnassociatedAlpha", 1);
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &as_stored);
  if (!input) return cannot_read(path, OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.deep) return cannot_read(path, "it holds deep pixels; a flat image is needed");
  LoadedImage image = describe(spec);
  image.pixels.resize(static_cast<std::size_t>(image.extent.area()) * image.channels.size());
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, image.pixels.data())) {
    return cannot_read(path, input->geterror());
  }
  return image;
}

}  // namespace

Status write_png(const std::string& path, Extent extent, const std::uint8_t* rgba, std::size_t row_bytes,
                 PngAlpha alpha) {
  if (Status status = check_extent(path, extent); !status.ok()) return status;
  if (rgba == nullptr) return Status::invalid(fmt::format("'{}': there are no texels to write", path));
  const int channels = alpha == PngAlpha::kKeep ? 4 : 3;
  OIIO::ImageSpec spec(extent.width, extent.height, channels, OIIO::TypeUInt8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("png:compressionLevel", kPngCompressionLevel);
  spec.attribute("png:filter", kPngFilterUp);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  const std::size_t row = row_bytes != 0 ? row_bytes : static_cast<std::size_t>(extent.width) * 4;
  return write_whole(path, "png", spec, OIIO::TypeUInt8, rgba, 4, static_cast<OIIO::stride_t>(row));
}

Result<std::vector<std::uint8_t>> encode_png(Extent extent, int channels,
                                             std::span<const std::uint8_t> texels) {
  if (Status status = check_extent("PNG", extent); !status.ok()) return status;
  if ((channels != 1 && channels != 3) ||
      texels.size() != static_cast<std::size_t>(extent.area()) * static_cast<std::size_t>(channels)) {
    return Status::invalid(fmt::format("a PNG of {}x{} pixels cannot be made from {} texels of {} channels",
                                       extent.width, extent.height, texels.size(), channels));
  }
  OIIO::ImageSpec spec(extent.width, extent.height, channels, OIIO::TypeUInt8);
  spec.attribute("png:compressionLevel", kPngSmallest);
  spec.attribute("png:filter", kPngFilterAll);
  std::vector<std::uint8_t> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("png");
  if (!output) return cannot_write("PNG", OIIO::geterror());
  output->set_ioproxy(&memory);
  if (!output->open("memory.png", spec) || !output->write_image(OIIO::TypeUInt8, texels.data()) ||
      !output->close()) {
    return cannot_write("PNG", output->geterror());
  }
  return bytes;
}

Status write_exr(const std::string& path, Extent extent, std::span<const Channel> channels,
                 std::span<const Attribute> attributes) {
  if (Status status = check_extent(path, extent); !status.ok()) return status;
  if (Status status = check_channels(path, channels); !status.ok()) return status;
  OIIO::ImageSpec spec(extent.width, extent.height, static_cast<int>(channels.size()), OIIO::TypeHalf);
  std::size_t pixel_bytes = 0;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    spec.channelnames[i] = channels[i].name;
    spec.channelformats.push_back(type_of(channels[i].stored));
    pixel_bytes += size_of(channels[i].stored);
  }
  spec.attribute("compression", fmt::format("zip:{}", kZipCompressionLevel));
  spec.attribute("DateTime", "");  // else the present moment: the same pixels make the same file
  set_attributes(spec, attributes);
  const Result<std::vector<std::byte>> native = interleave(path, extent, channels, pixel_bytes);
  if (!native.ok()) return native.status();
  return write_whole(path, "openexr", spec, OIIO::TypeUnknown, native->data(), OIIO::AutoStride,
                     OIIO::AutoStride);
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
  if (!std::filesystem::exists(path, error)) return cannot_read(path, "there is no such file");
  if (std::filesystem::is_directory(path, error)) return cannot_read(path, "it is a folder");
  try {
    return read_unguarded(path);
  } catch (const std::exception& problem) {  // a damaged header may ask for absurd memory
    return cannot_read(path, problem.what());
  }
}

}  // namespace quincunx::tools
