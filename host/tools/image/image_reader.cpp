// SPDX-License-Identifier: MIT
#include "tools/image/image_reader.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfTestFile.h>
#include <ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <exception>
#include <fstream>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "tools/image/image_attributes.h"
#include "tools/program/atomic_file.h"

namespace quincunx::tools {
namespace {

// Rows that are read at once where the data window is wider than the display window.
constexpr int kBandRows = 64;

// OpenEXR's messages may run over several lines; one sentence is enough.
Status cannot_read(const std::string& path, std::string reason) {
  reason.resize(std::min(reason.find('\n'), reason.size()));
  return Status::io(
      fmt::format("'{}' cannot be read: {}", path, reason.empty() ? "no reason was given" : reason));
}

ImageWindow window_of(const Imath::Box2i& box) {
  return {box.min.x, box.min.y, {box.max.x - box.min.x + 1, box.max.y - box.min.y + 1}};
}

// Channels by layer; within one R, G, B, A before others. OpenEXR has them by name.
auto order_of(const HeaderChannel& channel) {
  const std::size_t dot = channel.name.rfind('.') + 1;  // 0 where there is none
  const std::string own = channel.name.substr(dot);
  const std::size_t colour = own.size() == 1 ? std::string("RGBA").find(own) : std::string::npos;
  return std::tuple(channel.name.substr(0, dot), colour, own);
}

ImagePart describe(const Imf::Header& header) {
  ImagePart part;
  if (header.hasName()) part.name = header.name();
  part.data = window_of(header.dataWindow());
  part.display = window_of(header.displayWindow());
  part.deep = header.hasType() && Imf::isDeepData(header.type());
  part.dwa = header.compression() == Imf::DWAA_COMPRESSION || header.compression() == Imf::DWAB_COMPRESSION;
  for (auto found = header.channels().begin(); found != header.channels().end(); ++found) {
    const Imf::PixelType type = found.channel().type;
    part.channels.push_back({.name = found.name(),
                             .stored = type == Imf::HALF ? ChannelType::kHalf : ChannelType::kFloat,
                             .integer = type == Imf::UINT});
  }
  std::sort(part.channels.begin(), part.channels.end(),
            [](const HeaderChannel& a, const HeaderChannel& b) { return order_of(a) < order_of(b); });
  return part;
}

std::size_t bytes_of(ChannelType type) {
  return type == ChannelType::kHalf ? 2 : 4;
}

// Texels of one channel, of which the first is pixel (left, top) of the file.
Imf::Slice slice_at(int left, int top, ChannelType type, void* data, std::size_t pixel_stride,
                    std::size_t row_stride) {
  const auto back =
      left * static_cast<std::ptrdiff_t>(pixel_stride) + top * static_cast<std::ptrdiff_t>(row_stride);
  return {type == ChannelType::kHalf ? Imf::HALF : Imf::FLOAT, static_cast<char*>(data) - back, pixel_stride,
          row_stride};
}

using Targets = std::vector<ChannelTarget>;

// Those of one part, each channel once: OpenEXR takes one place for each. So a channel that is wanted twice is read
// twice.
std::vector<Targets> rounds_of(std::span<const ChannelTarget> targets) {
  std::vector<Targets> rounds;
  for (const ChannelTarget& target : targets) {
    const auto takes_it = [&](const Targets& round) {
      return round.front().from.part == target.from.part &&
             std::none_of(round.begin(), round.end(),
                          [&](const ChannelTarget& other) { return other.from == target.from; });
    };
    auto round = std::find_if(rounds.begin(), rounds.end(), takes_it);
    if (round == rounds.end()) round = rounds.emplace(rounds.end());
    round->push_back(target);
  }
  return rounds;
}

// Straight to where they belong.
void read_rows(Imf::InputPart& input, const ImagePart& part, const Targets& targets, int top, int bottom) {
  Imf::FrameBuffer buffer;
  for (const ChannelTarget& target : targets) {
    buffer.insert(part.channels[target.from.channel].name,
                  slice_at(part.display.x, part.display.y, target.type, target.data, target.pixel_stride,
                           target.row_stride));
  }
  input.setFrameBuffer(buffer);
  input.readPixels(top, bottom - 1);
}

// By way of whole rows of the data window, for it reaches beyond the display window at the sides.
void read_wide_rows(Imf::InputPart& input, const ImagePart& part, const Targets& targets, int top,
                    int bottom) {
  const ImageWindow& data = part.data;
  const int left = std::max(data.x, part.display.x);
  const int right = std::min(data.x + data.extent.width, part.display.x + part.display.extent.width);
  const auto width = static_cast<std::size_t>(data.extent.width);
  std::vector<std::byte> planes(targets.size() * sizeof(float) * width * kBandRows);
  const auto plane_of = [&](std::size_t i) { return planes.data() + i * sizeof(float) * width * kBandRows; };
  for (int begin = top; begin < bottom; begin += kBandRows) {
    const int end = std::min(begin + kBandRows, bottom);
    Imf::FrameBuffer buffer;
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const std::size_t texel = bytes_of(targets[i].type);
      buffer.insert(part.channels[targets[i].from.channel].name,
                    slice_at(data.x, begin, targets[i].type, plane_of(i), texel, texel * width));
    }
    input.setFrameBuffer(buffer);
    input.readPixels(begin, end - 1);
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const ChannelTarget& target = targets[i];
      const std::size_t texel = bytes_of(target.type);
      for (int y = begin; y < end; ++y) {
        const std::byte* from = plane_of(i) + ((y - begin) * width + (left - data.x)) * texel;
        std::byte* to = static_cast<std::byte*>(target.data) + (y - part.display.y) * target.row_stride +
                        (left - part.display.x) * target.pixel_stride;
        for (int x = left; x < right; ++x, from += texel, to += target.pixel_stride)
          std::memcpy(to, from, texel);
      }
    }
  }
}

static_assert(std::endian::native == std::endian::little, "the numbers of the file are read as they are");

constexpr std::uint32_t kMagic = 20000630;
constexpr std::uint32_t kOneTiledPart = 0x200, kSeveralParts = 0x1000;  // flags of the version
constexpr std::size_t kLongestName = 255;
// Scanlines in a block, by the number of the compression: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB.
constexpr std::array<std::int64_t, 10> kLinesOfBlock = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};

// The file's bytes in order; after a read beyond its end nothing more is good.
class Bytes {
 public:
  explicit Bytes(const std::string& path) : file_(path, std::ios::binary | std::ios::ate) {
    size_ = file_ ? static_cast<std::int64_t>(file_.tellg()) : 0;
    file_.seekg(0);
  }

  template <typename Number>
  Number take() {
    Number number = {};
    file_.read(reinterpret_cast<char*>(&number), sizeof number);
    return number;
  }

  std::string take_name() {
    std::string name;
    for (char c; file_.get(c) && c != 0;) {
      if (name.size() == kLongestName) file_.setstate(std::ios::failbit);
      name += c;
    }
    return name;
  }

  std::string take_text(std::int64_t length) {
    if (length < 0 || length > left()) file_.setstate(std::ios::failbit);
    std::string text(file_ ? static_cast<std::size_t>(length) : 0, '\0');
    file_.read(text.data(), static_cast<std::streamsize>(text.size()));
    return text;
  }

  bool good() const { return static_cast<bool>(file_); }
  std::int64_t size() const { return size_; }
  std::int64_t left() { return size_ - static_cast<std::int64_t>(file_.tellg()); }
  void go_to(std::int64_t place) { file_.seekg(place); }

 private:
  std::ifstream file_;
  std::int64_t size_ = 0;
};

struct Part {
  std::array<std::int32_t, 4> window = {};  // left, top, right, bottom; the last two within
  std::array<std::uint32_t, 2> tile = {};
  std::uint8_t levels = 0;  // 0: one; else mipmaps
  std::uint8_t compression = 0xff;
  std::optional<std::int32_t> blocks;
  bool tiled = false;
  bool deep = false;
};

template <typename Value>
void keep(const std::string& bytes, std::size_t at, Value& value) {
  if (bytes.size() >= at + sizeof value) std::memcpy(&value, bytes.data() + at, sizeof value);
}

void keep_attribute(const std::string& name, const std::string& value, Part& part) {
  if (name == "dataWindow") keep(value, 0, part.window);
  if (name == "compression") keep(value, 0, part.compression);
  if (name == "chunkCount") keep(value, 0, part.blocks.emplace());
  if (name == "tiles") {
    keep(value, 0, part.tile);
    keep(value, sizeof part.tile, part.levels);
  }
  if (name == "type") {
    part.tiled = value.ends_with("tile") || value == "tiledimage";
    part.deep = value.starts_with("deep");
  }
}

// Nothing for the empty header that ends several, or after the file's end.
std::optional<Part> take_header(Bytes& bytes) {
  Part part;
  std::string name = bytes.take_name();
  if (name.empty()) return std::nullopt;
  for (; bytes.good() && !name.empty(); name = bytes.take_name()) {
    bytes.take_name();  // the type's name
    keep_attribute(name, bytes.take_text(bytes.take<std::int32_t>()), part);
  }
  return bytes.good() ? std::optional(part) : std::nullopt;
}

std::int64_t parts_of(std::int64_t length, std::int64_t part) {
  return part > 0 ? (length + part - 1) / part : 0;
}

// Nothing where the header does not tell.
std::optional<std::int64_t> count_blocks(const Part& part) {
  if (part.blocks) return *part.blocks;
  const std::int64_t width = std::int64_t{part.window[2]} - part.window[0] + 1;
  const std::int64_t height = std::int64_t{part.window[3]} - part.window[1] + 1;
  if (width < 1 || height < 1) return std::nullopt;
  if (part.tiled) {
    if (part.levels != 0) return std::nullopt;
    return parts_of(width, part.tile[0]) * parts_of(height, part.tile[1]);
  }
  if (part.compression >= kLinesOfBlock.size()) return std::nullopt;
  return parts_of(height, kLinesOfBlock[part.compression]);
}

struct Block {
  std::int64_t offset = 0;
  std::int64_t head = 0;  // bytes before the pixels, of which the last four are their size; 0: not looked at
};

class Blocks {
 public:
  explicit Blocks(const std::string& path) : path_(path), bytes_(path) {}

  Status check() {
    const std::vector<Part> parts = take_parts();
    if (parts.empty() || !bytes_.good()) return {};
    for (const Part& part : parts) {
      const auto count = count_blocks(part);
      if (!count || *count < 0) return {};
      count_ += *count;
      if (*count > bytes_.left() / 8) return cut_short(count_);
      add_table(part, *count);
    }
    return missing_ > 0 || last_is_cut() ? cut_short(std::max<std::int64_t>(missing_, 1)) : Status();
  }

 private:
  std::vector<Part> take_parts() {
    if (bytes_.take<std::uint32_t>() != kMagic) return {};
    const auto version = bytes_.take<std::uint32_t>();
    several_ = (version & kSeveralParts) != 0;
    std::vector<Part> parts;
    while (auto part = take_header(bytes_)) {
      part->tiled |= (version & kOneTiledPart) != 0;
      parts.push_back(*part);
      if (!several_) break;
    }
    return parts;
  }

  void add_table(const Part& part, std::int64_t count) {
    const std::int64_t head = (several_ ? 4 : 0) + (part.tiled ? 20 : 8);
    for (std::int64_t i = 0; i < count; ++i) {
      const auto offset = bytes_.take<std::int64_t>();
      if (offset <= 0 || offset > bytes_.size() - head) {
        ++missing_;
      } else if (offset > last_.offset) {
        last_ = {offset, part.deep ? 0 : head};
      }
    }
  }

  // Blocks do not overlap, so none but the last can lie partly beyond the end.
  bool last_is_cut() {
    if (last_.head == 0) return false;
    bytes_.go_to(last_.offset + last_.head - 4);
    return bytes_.take<std::uint32_t>() > bytes_.left();
  }

  Status cut_short(std::int64_t missing) const {
    return Status::io(
        fmt::format("'{}' is cut short: {} of its {} blocks of pixels {} missing; render or copy it again",
                    path_, missing, count_, missing == 1 ? "is" : "are"));
  }

  const std::string& path_;
  Bytes bytes_;
  bool several_ = false;
  std::int64_t count_ = 0;
  std::int64_t missing_ = 0;
  Block last_;
};

}  // namespace

struct ImageReader::Impl {
  explicit Impl(const std::string& name) : path(name), file(name.c_str()) {
    header.attributes = attributes_of(file.header(0));
    for (int part = 0; part < file.parts(); ++part)
      header.parts.push_back(describe(file.header(part)));
  }

  void read(const Targets& targets) {
    const int index = targets.front().from.part;
    const ImagePart& part = header.parts[index];
    const int top = std::max(part.data.y, part.display.y);
    const int bottom =
        std::min(part.data.y + part.data.extent.height, part.display.y + part.display.extent.height);
    const int left = std::max(part.data.x, part.display.x);
    const int right =
        std::min(part.data.x + part.data.extent.width, part.display.x + part.display.extent.width);
    if (top >= bottom || left >= right) return;
    Imf::InputPart input(file, index);
    const bool wide = right - left < part.data.extent.width;
    (wide ? read_wide_rows : read_rows)(input, part, targets, top, bottom);
  }

  std::string path;
  Imf::MultiPartInputFile file;
  ImageHeader header;
};

ImageReader::ImageReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ImageReader::~ImageReader() = default;
ImageReader::ImageReader(ImageReader&&) noexcept = default;
ImageReader& ImageReader::operator=(ImageReader&&) noexcept = default;

Result<ImageReader> ImageReader::open(const std::string& path) {
  if (Status status = check_readable(path); !status.ok()) return status;
  try {
    if (!Imf::isOpenExrFile(path.c_str())) return cannot_read(path, "it is no EXR file");
    return ImageReader(std::make_unique<Impl>(path));
  } catch (const std::exception& problem) {  // a damaged header may ask for absurd memory
    return cannot_read(path, problem.what());
  }
}

const ImageHeader& ImageReader::header() const {
  return impl_->header;
}

Status ImageReader::read(std::span<const ChannelTarget> targets) {
  try {
    for (const Targets& round : rounds_of(targets))
      impl_->read(round);
  } catch (const std::exception& problem) {
    return cannot_read(impl_->path, problem.what());
  }
  return {};
}

std::optional<ChannelPlace> ImageHeader::find(std::string_view name) const {
  const auto search = [&](auto&& matches) -> std::optional<ChannelPlace> {
    for (std::size_t p = 0; p < parts.size(); ++p) {
      for (std::size_t c = 0; c < parts[p].channels.size(); ++c) {
        if (matches(parts[p], parts[p].channels[c]))
          return ChannelPlace{static_cast<int>(p), static_cast<int>(c)};
      }
    }
    return std::nullopt;
  };
  const auto found =
      search([&](const ImagePart&, const HeaderChannel& channel) { return channel.name == name; });
  if (found) return found;
  return search([&](const ImagePart& part, const HeaderChannel& channel) {
    return name.size() == part.name.size() + 1 + channel.name.size() && name.starts_with(part.name) &&
           name[part.name.size()] == '.' && name.ends_with(channel.name);
  });
}

const Attribute* ImageHeader::attribute(std::string_view name) const {
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [&](const Attribute& attribute) { return attribute.name == name; });
  return found == attributes.end() ? nullptr : &*found;
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

void set_exr_threads(int threads) {
  Imf::setGlobalThreadCount(threads);
}

Status check_blocks(const std::string& path) {
  return Blocks(path).check();
}

}  // namespace quincunx::tools
