// SPDX-License-Identifier: MIT
// ImageReader: an EXR file's header, and just those of its channels that are wanted.
//
// Knows several parts, tiles, any compression, and data windows that are not the display window. Contents that cannot
// be used (deep pixels, channels of integers) are said in the header and left to the caller to refuse.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "quincunx/status.h"
#include "tools/image/image_io.h"

namespace quincunx::tools {

// A rectangle of pixels; (x, y) is the upper left one, y down.
struct ImageWindow {
  int x = 0;
  int y = 0;
  Extent extent;

  friend bool operator==(const ImageWindow&, const ImageWindow&) = default;
};

struct HeaderChannel {
  std::string name;
  ChannelType stored = ChannelType::kHalf;
  bool integer = false;  // neither half nor float; `stored` then means nothing
};

struct ImagePart {
  std::string name;  // may be empty
  ImageWindow data;
  ImageWindow display;
  bool deep = false;
  bool dwa = false;  // compressed by DWAA or DWAB
  std::vector<HeaderChannel> channels;
};

struct ChannelPlace {
  int part = 0;
  int channel = 0;  // index in that part

  friend bool operator==(const ChannelPlace&, const ChannelPlace&) = default;
};

struct ImageHeader {
  std::vector<ImagePart> parts;       // at least one
  std::vector<Attribute> attributes;  // the first part's

  // By the channel's own name in whichever part has it first, else as "PART.CHANNEL".
  std::optional<ChannelPlace> find(std::string_view name) const;
  const HeaderChannel& at(ChannelPlace place) const { return parts[place.part].channels[place.channel]; }
  const Attribute* attribute(std::string_view name) const;  // null when there is none
  std::string channel_names() const;  // for messages: "R, G, B, Z", of several parts "rgba.R, ..."
};

// Where the pixels of one channel go. `data` is the texel of the display window's upper left pixel.
struct ChannelTarget {
  ChannelPlace from;
  ChannelType type = ChannelType::kHalf;  // type of the texels; converted where the file holds another
  void* data = nullptr;
  std::size_t pixel_stride = 0;  // bytes
  std::size_t row_stride = 0;    // bytes
};

// One open file. Move-only; one thread at a time.
class ImageReader {
 public:
  // Errors: kIoFailure for a file that is missing, damaged or no EXR.
  static Result<ImageReader> open(const std::string& path);

  ~ImageReader();
  ImageReader(ImageReader&&) noexcept;
  ImageReader& operator=(ImageReader&&) noexcept;

  const ImageHeader& header() const;

  // Reads the channels, each file block as few times as may be, with a few megabytes beside the targets.
  // Texels of the display window that the data window does not cover stay as they are. Errors: kIoFailure
  // for a damaged file; the targets then hold anything.
  Status read(std::span<const ChannelTarget> targets);

 private:
  struct Impl;
  explicit ImageReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// Sets the number of threads with which OpenEXR works inside one file, for the process; 0: the caller's alone.
void set_exr_threads(int threads);

// Checks whether a file holds all of its pixels, from its size and its tables of offsets alone. Reads the headers and
// the tables of all parts, and no pixels: well under a millisecond. For files whose headers are known to be good
// (ImageReader::open). It says nothing of a file that is no EXR, of mipmaps, and of a compression that it does not
// know. Errors: kIoFailure where blocks (scanlines or tiles) were never written or lie beyond the file's end: a copy or
// a renderer that was broken off. One sentence that names `path`. Thread-safe.
// Source: "OpenEXR File Layout", OpenEXR documentation.
Status check_blocks(const std::string& path);

}  // namespace quincunx::tools
