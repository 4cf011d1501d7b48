// SPDX-License-Identifier: MIT
// Whether a file is whole, by its own tables or its end: libraries tell that only by reading every pixel, if at all.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/image/image_reader.h"
#include "tools/program/atomic_file.h"
#include "tools/program/lower_case.h"

namespace quincunx::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "the numbers of the file are read as they are");

constexpr std::uint32_t kMagic = 20000630;
constexpr std::uint32_t kOneTiledPart = 0x200, kSeveralParts = 0x1000;  // flags of the version
constexpr std::size_t kLongestName = 255;
constexpr int kLongestNumber = 20;
// Scanlines in a block, by the number of the compression: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB.
constexpr std::array<std::int64_t, 10> kLinesOfBlock = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};

// Whatever a header says, a picture's bytes can be counted.
std::int64_t side_of(std::int64_t number) {
  constexpr std::int64_t kMost = 1 << 24;
  return std::clamp<std::int64_t>(number, 0, kMost);
}

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

  // A number or another word after blanks and comments, as portable maps have them.
  std::string take_word() {
    std::string word;
    while ((file_ >> std::ws).peek() == '#')
      file_.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    file_ >> std::setw(kLongestNumber) >> word;
    return word;
  }
  std::int64_t take_side() { return side_of(std::atoll(take_word().c_str())); }

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
  std::uint8_t levels = 0;  // as count_tiles() takes them
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

// Tiles of all levels: of one, of mipmaps, or of ripmaps. Nothing where the header means none of these.
std::optional<std::int64_t> count_tiles(const Part& part, std::int64_t width, std::int64_t height) {
  const int mode = part.levels & 0xf;
  const bool rounds_up = part.levels >> 4 != 0;
  const auto halved = [&](std::int64_t length, int times) {
    return std::max<std::int64_t>((length + (rounds_up ? (std::int64_t{1} << times) - 1 : 0)) >> times, 1);
  };
  const auto levels_of = [&](std::int64_t length) {
    int levels = 1;
    while (halved(length, levels - 1) > 1)
      ++levels;
    return levels;
  };
  const auto tiles_at = [&](int across, int down) {
    return parts_of(halved(width, across), part.tile[0]) * parts_of(halved(height, down), part.tile[1]);
  };
  if (mode == 0) return tiles_at(0, 0);
  if (mode > 2) return std::nullopt;
  std::int64_t tiles = 0;
  const int most = levels_of(std::max(width, height));
  for (int i = 0; i < most; ++i) {
    for (int j = 0; j < most; ++j) {
      const bool is_level = mode == 1 ? i == j : i < levels_of(width) && j < levels_of(height);
      if (is_level) tiles += tiles_at(i, j);
    }
  }
  return tiles;
}

// Nothing where the header does not tell.
std::optional<std::int64_t> count_blocks(const Part& part) {
  if (part.blocks) return *part.blocks;
  const std::int64_t width = std::int64_t{part.window[2]} - part.window[0] + 1;
  const std::int64_t height = std::int64_t{part.window[3]} - part.window[1] + 1;
  if (width < 1 || height < 1) return std::nullopt;
  if (part.tiled) return count_tiles(part, width, height);
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

// Returns where the pixels of a binary portable map end. Source: netpbm's pages of PBM, PGM and PPM; Debevec's of PFM.
std::int64_t end_of_map(Bytes& bytes, char kind) {
  const bool is_bits = kind == '4', is_float = kind == 'f' || kind == 'F';
  bytes.go_to(2);
  const std::int64_t width = bytes.take_side(), height = bytes.take_side();
  const std::int64_t code = is_float ? 4 : !is_bits && bytes.take_side() > 255 ? 2 : 1;
  if (is_float) bytes.take_word();  // its scale
  const std::int64_t row = is_bits ? (width + 7) / 8 : width * code * (kind == '6' || kind == 'F' ? 3 : 1);
  return bytes.size() - bytes.left() + 1 + row * height;
}

// Returns where the pixels of a BMP end; 0 where they are compressed.
std::int64_t end_of_bmp(Bytes& bytes) {
  constexpr std::uint32_t kOldHeader = 12, kMasks = 3;
  bytes.go_to(10);
  const auto first = bytes.take<std::uint32_t>(), header = bytes.take<std::uint32_t>();
  const bool old = header == kOldHeader;
  const auto take_side = [&] {  // a negative height: from the top down
    return side_of(old ? bytes.take<std::uint16_t>() : std::abs(std::int64_t{bytes.take<std::int32_t>()}));
  };
  const std::int64_t width = take_side(), height = take_side();
  bytes.take<std::uint16_t>();  // planes
  const std::int64_t bits = bytes.take<std::uint16_t>();
  const auto compression = old ? 0 : bytes.take<std::uint32_t>();
  return compression == 0 || compression == kMasks ? first + (width * bits + 31) / 32 * 4 * height : 0;
}

// Returns where the pixels of a TGA end; 0 where they are compressed.
std::int64_t end_of_tga(Bytes& bytes) {
  bytes.go_to(0);
  const std::int64_t name = bytes.take<std::uint8_t>();
  bytes.take<std::uint8_t>();
  const auto type = bytes.take<std::uint8_t>();
  bytes.take<std::uint16_t>();  // first colour of a map
  const std::int64_t colours = bytes.take<std::uint16_t>(), colour_bits = bytes.take<std::uint8_t>();
  bytes.take<std::uint32_t>();  // origin
  const std::int64_t width = bytes.take<std::uint16_t>(), height = bytes.take<std::uint16_t>();
  const std::int64_t pixel = (bytes.take<std::uint8_t>() + 7) / 8;
  constexpr int kHeader = 18, kLeastCompressed = 8;
  return type < kLeastCompressed ? kHeader + name + colours * ((colour_bits + 7) / 8) + width * height * pixel
                                 : 0;
}

// Returns whether a file that is no EXR ends as its format has it. True for a format that is not known.
bool end_is_there(Bytes& bytes, const std::string& path) {
  using namespace std::string_view_literals;
  const std::string begin = bytes.take_text(std::min<std::int64_t>(bytes.size(), 20));
  const auto reaches = [&bytes](std::int64_t end) { return bytes.good() && end <= bytes.size(); };
  if (begin.size() > 2 && begin[0] == 'P' && "456fF"sv.find(begin[1]) != std::string_view::npos)
    return reaches(end_of_map(bytes, begin[1]));
  if (begin.starts_with("BM")) return reaches(end_of_bmp(bytes));
  if (begin.starts_with("RIFF"))  // WebP
    return reaches(8 + static_cast<std::int64_t>(number_of(begin.substr(4, 4), false)));
  if (in_lower_case(path).ends_with(".tga")) return reaches(end_of_tga(bytes));
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
  if (!end_is_there(bytes, path))
    return Status::io(fmt::format("'{}' is cut short: its end is missing; render or copy it again", path));
  return Blocks(path).check();
}

}  // namespace quincunx::tools
