// SPDX-License-Identifier: MIT
#include "tools/image/exr_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <vector>

namespace quincunx::tools {
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
    bytes.take_name();  // of its type
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

Status check_blocks(const std::string& path) {
  return Blocks(path).check();
}

}  // namespace quincunx::tools
