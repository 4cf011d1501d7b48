// SPDX-License-Identifier: MIT
// Common work of both libraries: checks of arguments, writing of files, and finding of channels.
#include "tools/image/image_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

#include "tools/image/display_light.h"
#include "tools/image/image_reader.h"
#include "tools/program/atomic_file.h"

namespace quincunx::tools {

namespace {

// Adds what a PNG's cICP chunk says of its codes, by numbers of ITU-T H.273. The chunk comes before the pixels,
// and overrules the others. Source: "Portable Network Graphics (Third Edition)", W3C, 2025.
void add_png_coding(const std::string& path, ImagePart& part) {
  std::ifstream file(path, std::ios::binary);
  std::array<unsigned char, 8> signature{};
  std::array<unsigned char, 4> length{}, type{}, coding{};
  const auto take = [&file](auto& bytes) -> bool {
    return static_cast<bool>(file.read(reinterpret_cast<char*>(bytes.data()), bytes.size()));
  };
  const auto is = [&type](std::string_view name) {
    return std::equal(name.begin(), name.end(), type.begin());
  };
  if (!take(signature) ||
      signature != std::array<unsigned char, 8>{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'})
    return;
  while (take(length) && take(type) && !is("cICP")) {
    if (is("IDAT")) return;
    const std::uint32_t bytes = std::uint32_t{length[0]} << 24 | length[1] << 16 | length[2] << 8 | length[3];
    file.seekg(std::streamoff{bytes} + 4, std::ios::cur);
  }
  if (!take(coding)) return;
  constexpr int kRec709 = 1, kLinear = 8, kSrgb = 13;
  constexpr int kNearlySrgb[] = {1, 6, kSrgb, 14, 15};
  const int primaries = coding[0], transfer = coding[1];
  const bool full = coding[3] != 0;
  const std::string name = fmt::format("cICP {}/{}{}", primaries, transfer, full ? "" : " of a narrow range");
  part.unapplied.clear();
  if (full && primaries == kRec709 && (transfer == kSrgb || transfer == kLinear)) {
    part.colour_space = transfer == kSrgb ? "sRGB" : "linear";
  } else if (full &&
             std::find(std::begin(kNearlySrgb), std::end(kNearlySrgb), transfer) != std::end(kNearlySrgb)) {
    part.colour_space = "sRGB";
    part.unapplied = name;
  } else {
    part.colour_space = name;
  }
}

// Libraries' messages may run over several lines; one sentence is enough.
Status cannot_read(const std::string& path, std::string reason) {
  reason.resize(std::min(reason.find('\n'), reason.size()));
  return Status::io(
      fmt::format("'{}' cannot be read: {}", path, reason.empty() ? "no reason was given" : reason));
}

// Channels by layer; within one R, G, B, X, Y, A before others.
auto order_of(const HeaderChannel& channel) {
  const std::size_t dot = channel.name.rfind('.') + 1;  // 0 where there is none
  const std::string own = channel.name.substr(dot);
  const std::size_t colour = own.size() == 1 ? std::string("RGBXYA").find(own) : std::string::npos;
  return std::tuple(channel.name.substr(0, dot), colour, own);
}

Status cannot_write(const std::string& path, std::string reason) {
  reason.resize(std::min(reason.find('\n'), reason.size()));
  return Status::io(fmt::format("'{}' cannot be written: {}", path, reason));
}

Status check_extent(const std::string& path, Extent extent) {
  if (extent.width >= 1 && extent.height >= 1) return {};
  return Status::invalid(
      fmt::format("'{}': an image of {}x{} pixels cannot be written; each side must be at "
                  "least 1",
                  path, extent.width, extent.height));
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

// Codes of 10 bits in the upper bits of 16, as OpenImageIO widens and narrows them.
std::vector<std::uint16_t> display_codes(const std::vector<float>& light) {
  std::vector<std::uint16_t> codes;
  codes.reserve(light.size());
  for (const float value : light) {
    const auto code = static_cast<unsigned>(std::lround(srgb_of_linear(value) * 1023));
    codes.push_back(static_cast<std::uint16_t>(code << 6 | code >> 4));
  }
  return codes;
}

Status write_bytes(const std::string& path, const Result<backend::Bytes>& bytes) {
  if (!bytes.ok()) return cannot_write(path, bytes.status().message());
  return write_text(path, {reinterpret_cast<const char*>(bytes->data()), bytes->size()});
}

}  // namespace

std::optional<FileFormat> format_of(std::string_view path) {
  std::string ending(path.substr(std::min(path.rfind('.'), path.size())));
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  for (const backend::Ending& known : backend::written_endings())
    if (known.text == ending) return known.format;
  return std::nullopt;
}

namespace {

template <typename Keep>
std::string endings_of(Keep keep) {
  std::vector<std::string_view> texts;
  std::set<FileFormat> formats;
  for (const backend::Ending& known : backend::written_endings())
    if (keep(known.format) && formats.insert(known.format).second) texts.push_back(known.text);
  const auto last = texts.end() - 1;
  return texts.size() == 1 ? std::string(*last)
                           : fmt::format("{} or {}", fmt::join(texts.begin(), last, ", "), *last);
}

bool holds_codes(FileFormat format) {
  return format != FileFormat::kExr && format != FileFormat::kHdr;
}

}  // namespace

std::string endings() {
  return endings_of([](FileFormat) { return true; });
}

Result<FramePattern> output_pattern(const std::string& text) {
  auto pattern = FramePattern::parse(text);
  if (!pattern.ok() || format_of(text)) return pattern;
  const std::string ending = std::filesystem::path(text).extension().string();
  return Status::invalid(
      fmt::format("output pattern '{}' {}; it must end in {}", text,
                  ending.empty() ? "has no extension" : fmt::format("ends in '{}'", ending), endings()));
}

std::string no_picture(const std::string& path) {
  const auto format = format_of(path);
  if (format && holds_codes(*format)) return {};
  return fmt::format("'{}' must end in {}", path, endings_of(holds_codes));
}

Status write_picture(const std::string& path, Extent extent, const std::uint8_t* rgba, std::size_t row_bytes,
                     Alpha alpha, std::span<const Attribute> attributes) {
  if (Status status = check_extent(path, extent); !status.ok()) return status;
  if (rgba == nullptr) return Status::invalid(fmt::format("'{}': there are no texels to write", path));
  if (const std::string problem = no_picture(path); !problem.empty()) return Status::invalid(problem);
  const std::size_t row = row_bytes != 0 ? row_bytes : static_cast<std::size_t>(extent.width) * 4;
  return write_bytes(path, backend::encode(*format_of(path),
                                           {.extent = extent,
                                            .channels = alpha == Alpha::kKeep ? 4 : 3,
                                            .data = rgba,
                                            .pixel_stride = 4,
                                            .row_stride = row},
                                           attributes));
}

bool exceed_halves(std::span<const float> values) {
  return std::any_of(values.begin(), values.end(),
                     [](float value) { return std::abs(value) > kLargestHalf; });
}

Status write_light(const std::string& path, Extent extent, std::span<const float> rgba, ChannelType stored,
                   const Display& display, std::span<const Attribute> attributes) {
  if (Status status = check_extent(path, extent); !status.ok()) return status;
  const auto format = format_of(path);
  if (!format) return Status::invalid(fmt::format("'{}' must end in {}", path, endings()));
  const std::size_t width = static_cast<std::size_t>(extent.width), texel = 4 * sizeof(float);
  if (*format == FileFormat::kExr) {
    std::vector<float> held;
    if (stored == ChannelType::kHalf && exceed_halves(rgba)) {
      held.assign(rgba.begin(), rgba.end());
      for (float& value : held)
        if (std::abs(value) > kLargestHalf) value = std::copysign(kLargestHalf, value);
      rgba = held;
    }
    std::vector<Channel> channels;
    for (std::size_t i = 0; i < 4; ++i) {
      channels.push_back({.name = std::string(1, "RGBA"[i]),
                          .type = ChannelType::kFloat,
                          .data = rgba.data() + i,
                          .pixel_stride = texel,
                          .stored = stored});
    }
    return write_exr(path, extent, channels, attributes);
  }
  backend::Texels texels = {.extent = extent,
                            .channels = *format == FileFormat::kTiff ? 4 : 3,
                            .depth = backend::Depth::kFloat,
                            .data = rgba.data(),
                            .pixel_stride = texel,
                            .row_stride = width * texel};
  std::vector<float> positive;
  if (*format == FileFormat::kHdr) {  // RGBE has no other numbers
    positive.assign(rgba.begin(), rgba.end());
    for (float& value : positive)
      value = value > 0 ? std::min(value, 1e38f) : 0;
    texels.data = positive.data();
  }
  if (holds_light(*format)) return write_bytes(path, backend::encode(*format, texels, attributes));
  const std::vector<std::uint16_t> codes =
      display_codes(display_light(rgba, display.tone_map, display.exposure));
  texels.depth = backend::Depth::k16;
  texels.data = codes.data();
  texels.pixel_stride = 4 * sizeof codes[0];
  texels.row_stride = width * texels.pixel_stride;
  return write_bytes(path, backend::encode(*format, texels, attributes));
}

Result<std::vector<std::uint8_t>> encode_png(Extent extent, int channels,
                                             std::span<const std::uint8_t> texels) {
  if (Status status = check_extent("PNG", extent); !status.ok()) return status;
  const auto count = static_cast<std::size_t>(channels), width = static_cast<std::size_t>(extent.width);
  if ((channels != 1 && channels != 3) || texels.size() != static_cast<std::size_t>(extent.area()) * count) {
    return Status::invalid(fmt::format("a PNG of {}x{} pixels cannot be made from {} texels of {} channels",
                                       extent.width, extent.height, texels.size(), channels));
  }
  auto bytes = backend::encode(FileFormat::kPng, {.extent = extent,
                                                  .channels = channels,
                                                  .data = texels.data(),
                                                  .pixel_stride = count,
                                                  .row_stride = count * width,
                                                  .small = true});
  if (!bytes.ok()) return cannot_write("PNG", bytes.status().message());
  return bytes;
}

Status write_exr(const std::string& path, Extent extent, std::span<const Channel> channels,
                 std::span<const Attribute> attributes) {
  if (Status status = check_extent(path, extent); !status.ok()) return status;
  if (Status status = check_channels(path, channels); !status.ok()) return status;
  std::vector<Channel> packed(channels.begin(), channels.end());
  for (Channel& channel : packed) {
    if (channel.pixel_stride == 0) channel.pixel_stride = bytes_of(channel.type);
    if (channel.row_stride == 0)
      channel.row_stride = channel.pixel_stride * static_cast<std::size_t>(extent.width);
  }
  try {
    return write_bytes(path, backend::encode_exr(extent, packed, attributes));
  } catch (const std::exception& problem) {  // no memory
    return cannot_write(path, problem.what());
  }
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
  auto reader = ImageReader::open(path);
  if (!reader.ok()) return reader.status();
  const ImagePart& part = reader->header().parts.front();
  if (part.deep) return cannot_read(path, "it holds deep pixels; a flat image is needed");
  LoadedImage image = {.extent = part.display.extent,
                       .channels = {},
                       .stored = {},
                       .pixels = {},
                       .attributes = part.attributes};
  const std::size_t count = part.channels.size();
  try {
    image.pixels.resize(static_cast<std::size_t>(image.extent.area()) * count);
  } catch (const std::exception&) {
    return cannot_read(
        path, fmt::format("there is no memory for {}x{} pixels", image.extent.width, image.extent.height));
  }
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

Result<ImageReader> ImageReader::open(const std::string& path) {
  if (Status status = check_readable(path); !status.ok()) return status;
  try {
    ImageReader reader(path);
    reader.file_ = backend::ImageFile::open(path);
    for (ImagePart& part : reader.file_->header.parts) {
      add_png_coding(path, part);
      std::sort(part.channels.begin(), part.channels.end(),
                [](const HeaderChannel& a, const HeaderChannel& b) { return order_of(a) < order_of(b); });
    }
    return reader;
  } catch (const std::exception& problem) {  // a damaged header may ask for absurd memory
    return cannot_read(path, problem.what());
  }
}

Status ImageReader::read(std::span<const ChannelTarget> targets) {
  try {
    file_->read(targets);
    return {};
  } catch (const std::exception& problem) {
    return cannot_read(path_, problem.what());
  }
}

ImageWindow ImagePart::shown() const {
  const int x = std::max(data.x, display.x), y = std::max(data.y, display.y);
  return {x,
          y,
          {std::min(data.x + data.extent.width, display.x + display.extent.width) - x,
           std::min(data.y + data.extent.height, display.y + display.extent.height) - y}};
}

bool ImageHeader::is_called(ChannelPlace place, std::string_view name) const {
  const std::string &part = parts[place.part].name, &own = at(place).name;
  if (name == own) return true;
  return name.size() == part.size() + 1 + own.size() && name.starts_with(part) && name[part.size()] == '.' &&
         name.ends_with(own);
}

std::vector<ChannelPlace> ImageHeader::places_of(std::string_view name) const {
  std::vector<ChannelPlace> places;
  for (int p = 0; p < static_cast<int>(parts.size()); ++p) {
    for (int c = 0; c < static_cast<int>(parts[p].channels.size()); ++c)
      if (is_called({p, c}, name)) places.push_back({p, c});
  }
  return places;
}

std::optional<ChannelPlace> ImageHeader::find(std::string_view name) const {
  const std::vector<ChannelPlace> places = places_of(name);
  return places.empty() ? std::nullopt : std::optional(places.front());
}

const Attribute* ImageHeader::attribute(std::string_view name, int part) const {
  const std::vector<Attribute>& attributes = parts[static_cast<std::size_t>(part)].attributes;
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [&](const Attribute& attribute) { return attribute.name == name; });
  if (found != attributes.end()) return &*found;
  return part > 0 ? this->attribute(name) : nullptr;
}

std::string ImageHeader::channel_names() const {
  std::string names;
  for (const ImagePart& part : parts) {
    for (const HeaderChannel& channel : part.channels) {
      names += names.empty() ? "" : ", ";
      if (parts.size() > 1) names += part.name + ".";
      names += channel.name;
    }
  }
  return names;
}

}  // namespace quincunx::tools
