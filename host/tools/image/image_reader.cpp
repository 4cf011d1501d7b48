// SPDX-License-Identifier: MIT
#include "tools/image/image_reader.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>
#include <vector>

#include "tools/image/image_attributes.h"

namespace quincunx::tools {
namespace {

// Whole blocks of every common compression but DWAB (16 lines for ZIP, 32 for PIZ), so that the few channel
// runs of a band find the block unpacked that the run before them needed.
constexpr int kBandRows = 64;

Status cannot_read(const std::string& path, std::string reason) {
  reason.resize(std::min(reason.find('\n'), reason.size()));
  return Status::io(
      fmt::format("'{}' cannot be read: {}", path, reason.empty() ? "no reason was given" : reason));
}

ImagePart describe(const OIIO::ImageSpec& spec) {
  ImagePart part;
  part.name = spec.get_string_attribute("oiio:subimagename");
  part.data = {spec.x, spec.y, {spec.width, spec.height}};
  part.display = {spec.full_x, spec.full_y, {spec.full_width, spec.full_height}};
  part.deep = spec.deep;
  part.compression = spec.get_string_attribute("compression");
  for (int i = 0; i < spec.nchannels; ++i) {
    const OIIO::TypeDesc type = spec.channelformat(i);
    part.channels.push_back({.name = spec.channelnames[i],
                             .stored = type == OIIO::TypeHalf ? ChannelType::kHalf : ChannelType::kFloat,
                             .integer = type != OIIO::TypeHalf && type != OIIO::TypeFloat});
  }
  return part;
}

std::size_t size_of(ChannelType type) {
  return type == ChannelType::kHalf ? 2 : 4;
}

OIIO::TypeDesc type_of(ChannelType type) {
  return type == ChannelType::kHalf ? OIIO::TypeHalf : OIIO::TypeFloat;
}

// Channels of one part that lie side by side in the file and become texels of one type: read in one go.
struct Run {
  int part = 0;
  int first = 0;
  ChannelType type = ChannelType::kHalf;
  std::vector<ChannelTarget> targets;  // for channels first, first + 1, ...

  int end() const { return first + static_cast<int>(targets.size()); }
};

std::vector<Run> runs_of(std::span<const ChannelTarget> targets) {
  std::vector<ChannelTarget> sorted(targets.begin(), targets.end());
  std::sort(sorted.begin(), sorted.end(), [](const ChannelTarget& a, const ChannelTarget& b) {
    return std::pair(a.from.part, a.from.channel) < std::pair(b.from.part, b.from.channel);
  });
  std::vector<Run> runs;
  for (const ChannelTarget& target : sorted) {
    const bool joins = !runs.empty() && runs.back().part == target.from.part &&
                       runs.back().type == target.type && runs.back().end() == target.from.channel;
    if (!joins) runs.push_back({target.from.part, target.from.channel, target.type, {}});
    runs.back().targets.push_back(target);
  }
  return runs;
}

template <typename Texel>
void copy_row(const std::byte* from, std::size_t from_stride, std::byte* to, std::size_t to_stride,
              int count) {
  for (int i = 0; i < count; ++i)
    std::memcpy(to + i * to_stride, from + i * from_stride, sizeof(Texel));
}

// Rows [begin, end) of the data window, as the file counts them.
struct Band {
  int begin = 0;
  int end = 0;
};

// From the band's texels (the data window's width, the run's channels interleaved) to where they belong.
void scatter(const std::byte* texels, const Run& run, const ImagePart& part, Band band) {
  const ImageWindow& data = part.data;
  const ImageWindow& display = part.display;
  const std::size_t texel = size_of(run.type);
  const std::size_t pixel = texel * run.targets.size();
  const int left = std::max(data.x, display.x);
  const int right = std::min(data.x + data.extent.width, display.x + display.extent.width);
  const int top = std::max(band.begin, display.y);
  const int bottom = std::min(band.end, display.y + display.extent.height);
  for (std::size_t i = 0; i < run.targets.size(); ++i) {
    const ChannelTarget& target = run.targets[i];
    for (int y = top; y < bottom; ++y) {
      const std::size_t row = static_cast<std::size_t>(y - band.begin) * data.extent.width;
      const std::byte* from = texels + (row + (left - data.x)) * pixel + i * texel;
      std::byte* to = static_cast<std::byte*>(target.data) + (y - display.y) * target.row_stride +
                      (left - display.x) * target.pixel_stride;
      if (texel == 2) {
        copy_row<std::uint16_t>(from, pixel, to, target.pixel_stride, right - left);
      } else {
        copy_row<float>(from, pixel, to, target.pixel_stride, right - left);
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
  std::string path;
  std::unique_ptr<OIIO::ImageInput> input;
  ImageHeader header;

  Status open();
  Status read_part(int index, std::span<const Run> runs);
  bool read_band(const OIIO::ImageSpec& spec, const Run& run, Band band, std::byte* texels);
};

Status ImageReader::Impl::open() {
  input = OIIO::ImageInput::open(path);
  if (!input) return cannot_read(path, OIIO::geterror());
  if (std::strcmp(input->format_name(), "openexr") != 0) {
    return cannot_read(path, fmt::format("it is no EXR file but {}", input->format_name()));
  }
  header.attributes = attributes_of(input->spec());
  for (int index = 0; input->seek_subimage(index, 0); ++index)
    header.parts.push_back(describe(input->spec()));
  static_cast<void>(input->geterror());  // that there is no further part
  return {};
}

bool ImageReader::Impl::read_band(const OIIO::ImageSpec& spec, const Run& run, Band band, std::byte* texels) {
  if (spec.tile_width == 0) {
    return input->read_scanlines(run.part, 0, band.begin, band.end, 0, run.first, run.end(),
                                 type_of(run.type), texels);
  }
  return input->read_tiles(run.part, 0, spec.x, spec.x + spec.width, band.begin, band.end, 0, 1, run.first,
                           run.end(), type_of(run.type), texels);
}

Status ImageReader::Impl::read_part(int index, std::span<const Run> runs) {
  const ImagePart& part = header.parts[index];
  const OIIO::ImageSpec spec = input->spec_dimensions(index, 0);
  const int block = std::max(spec.tile_height, 1);
  const int rows = (kBandRows + block - 1) / block * block;
  const int data_end = part.data.y + part.data.extent.height;
  const int wanted_end = std::min(data_end, part.display.y + part.display.extent.height);
  std::vector<std::byte> texels;
  for (Band band = {part.data.y, 0}; band.begin < wanted_end; band.begin = band.end) {
    band.end = std::min(band.begin + rows, data_end);
    if (band.end <= part.display.y) continue;
    for (const Run& run : runs) {
      texels.resize(static_cast<std::size_t>(band.end - band.begin) * part.data.extent.width *
                    run.targets.size() * size_of(run.type));
      if (!read_band(spec, run, band, texels.data())) return cannot_read(path, input->geterror());
      scatter(texels.data(), run, part, band);
    }
  }
  return {};
}

ImageReader::ImageReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ImageReader::~ImageReader() = default;
ImageReader::ImageReader(ImageReader&&) noexcept = default;
ImageReader& ImageReader::operator=(ImageReader&&) noexcept = default;

Result<ImageReader> ImageReader::open(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return cannot_read(path, "there is no such file");
  if (std::filesystem::is_directory(path, error)) return cannot_read(path, "it is a folder");
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  try {
    if (Status status = impl->open(); !status.ok()) return status;
  } catch (const std::exception& problem) {  // a damaged header may ask for absurd memory
    return cannot_read(path, problem.what());
  }
  return ImageReader(std::move(impl));
}

const ImageHeader& ImageReader::header() const {
  return impl_->header;
}

Status ImageReader::read(std::span<const ChannelTarget> targets) {
  const std::vector<Run> runs = runs_of(targets);
  try {
    for (auto first = runs.begin(); first != runs.end();) {
      const auto end =
          std::find_if(first, runs.end(), [&](const Run& run) { return run.part != first->part; });
      if (Status status = impl_->read_part(first->part, {first, end}); !status.ok()) return status;
      first = end;
    }
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
  OIIO::attribute("exr_threads", threads == 0 ? -1 : threads);
}

Status check_blocks(const std::string& path) {
  return Blocks(path).check();
}

}  // namespace quincunx::tools
