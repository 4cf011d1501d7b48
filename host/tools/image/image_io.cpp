// SPDX-License-Identifier: MIT
// What both libraries have in common: arguments are checked and files written here, and channels found. So is whether
// a file is whole, by its own tables or its end: libraries tell that only by reading every pixel, or not at all.
#include "tools/image/image_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <set>
#include <tuple>
#include <utility>

#include "tools/image/display_light.h"
#include "tools/image/image_reader.h"
#include "tools/program/atomic_file.h"

namespace quincunx::tools {

namespace {

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

namespace {

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
    const auto size = bytes_.take<std::uint32_t>();
    return size == 0 || size > bytes_.left();
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

std::uint64_t number_of(std::string_view bytes, bool big_endian) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    number = number << 8 | static_cast<std::uint8_t>(bytes[big_endian ? i : bytes.size() - 1 - i]);
  return number;
}

// Returns whether all strips or tiles of a TIFF's first picture lie within the file.
// Source: "TIFF Revision 6.0", Adobe, 1992; BigTIFF as libtiff documents it.
bool tiff_is_whole(Bytes& bytes, bool big_endian) {
  constexpr std::uint64_t kStripOffsets = 273, kStripSizes = 279, kTileOffsets = 324, kTileSizes = 325;
  constexpr std::uint64_t kShort = 3, kLong = 4;
  constexpr std::uint64_t kCompression = 259, kLzw = 5, kDeflate = 8, kOldDeflate = 32946;
  const auto number = [&](std::string_view text) { return number_of(text, big_endian); };
  const auto take = [&](std::int64_t length) { return number(bytes.take_text(length)); };
  bytes.go_to(2);
  const bool wide = take(2) == 43;
  const std::int64_t word = wide ? 8 : 4;
  bytes.go_to(word);
  auto place = static_cast<std::int64_t>(take(word));
  bytes.go_to(place);
  std::uint64_t entries = take(wide ? 8 : 2);
  place += wide ? 8 : 2;
  std::vector<std::uint64_t> offsets, sizes;
  std::uint64_t compression = 0;
  for (; entries > 0 && bytes.good(); --entries, place += 4 + 2 * word) {
    bytes.go_to(place);
    const std::uint64_t tag = take(2), type = take(2);
    const auto count = static_cast<std::int64_t>(take(word));
    if (tag == kCompression && compression == 0) compression = take(2);
    const bool is_offset = tag == kStripOffsets || tag == kTileOffsets;
    std::vector<std::uint64_t>& numbers = is_offset ? offsets : sizes;
    if ((!is_offset && tag != kStripSizes && tag != kTileSizes) || !numbers.empty()) continue;
    const std::int64_t each = type == kShort ? 2 : type == kLong ? 4 : 8;
    if (count < 0 || count > bytes.size() / each) return false;
    if (count * each > word) bytes.go_to(static_cast<std::int64_t>(take(word)));
    for (std::int64_t i = 0; i < count; ++i)
      numbers.push_back(take(each));
  }
  for (std::size_t i = 0; i < std::min(offsets.size(), sizes.size()); ++i) {
    const auto whole = static_cast<std::uint64_t>(bytes.size());
    if (offsets[i] > whole || sizes[i] > whole - offsets[i]) return false;
    // Zeros are read as if all were well; the code or sum that ends such a strip or tile is none.
    const bool has_end = compression == kLzw || compression == kDeflate || compression == kOldDeflate;
    if (!has_end || sizes[i] < 4) continue;
    bytes.go_to(static_cast<std::int64_t>(offsets[i] + sizes[i] - 4));
    if (take(4) == 0) return false;
  }
  return bytes.good();
}

// Returns whether a file that is no EXR ends as its format has it. True for a format that is not known.
bool end_is_there(Bytes& bytes) {
  using namespace std::string_view_literals;
  const std::string begin = bytes.take_text(std::min<std::int64_t>(bytes.size(), 20));
  const bool jpeg = begin.starts_with("\xff\xd8\xff"), png = begin.starts_with("\x89PNG");
  if (jpeg || png) {
    constexpr std::int64_t kTail = 4096;  // zeros may follow the end
    bytes.go_to(std::max<std::int64_t>(bytes.size() - kTail, 0));
    std::string end = bytes.take_text(std::min(bytes.size(), kTail));
    end.resize(end.find_last_not_of('\0') + 1);
    return end.ends_with(jpeg ? "\xff\xd9" : "IEND\xae\x42\x60\x82");
  }
  const bool big_dpx = begin.starts_with("SDPX");
  if (big_dpx || begin.starts_with("XPDS")) {
    constexpr std::uint64_t kUndefined = 0xffffffff;
    const std::uint64_t said = begin.size() < 20 ? kUndefined : number_of(begin.substr(16, 4), big_dpx);
    return said == kUndefined || said <= static_cast<std::uint64_t>(bytes.size());
  }
  const bool big_tiff = begin.starts_with("MM\0*"sv) || begin.starts_with("MM\0+"sv);
  if (big_tiff || begin.starts_with("II*\0"sv) || begin.starts_with("II+\0"sv))
    return tiff_is_whole(bytes, big_tiff);
  return true;
}

}  // namespace

Status check_whole(const std::string& path) {
  if (Status status = check_readable(path); !status.ok()) return status;
  Bytes bytes(path);
  if (!end_is_there(bytes))
    return Status::io(fmt::format("'{}' is cut short: its end is missing; render or copy it again", path));
  return Blocks(path).check();
}

}  // namespace quincunx::tools
