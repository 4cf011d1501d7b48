// SPDX-License-Identifier: MIT
// ImageReader: an image file's header, and just those of its channels that are wanted.
//
// Knows several parts, tiles, any compression, and data windows that are not the display window. Contents that cannot
// be used (deep pixels, channels of integers) are said in the header and left to the caller to refuse. Files of codes
// (PNG, JPEG, TIFF and DPX of 8 or 16 bits) have values from 0 to 1, as encoded, and channels R, G, B, A or Y, A.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
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
  bool integer = false;                  // whole numbers that are no codes; `stored` then means nothing
  std::array<int, 2> sampling = {1, 1};  // pixels a sample, in x and y; another than 1 cannot be read
};

struct ImagePart {
  std::string name;  // may be empty
  ImageWindow data;
  ImageWindow display;
  bool deep = false;
  bool dwa = false;                       // compressed by DWAA or DWAB
  std::string view = {};                  // "left"; empty: none is named
  float pixel_aspect = 1;                 // width of a pixel over its height
  std::string colour_space = {};          // "linear", "sRGB", "Gamma2.2", as the file or its format has it
  std::string unapplied = {};             // what else it says of its colours, which nothing applies
  std::array<float, 3> gain = {1, 1, 1};  // makes light of linear colour
  std::optional<Chromaticities> chromaticities = {};
  bool straight_alpha = false;  // colour is not multiplied by alpha
  std::vector<HeaderChannel> channels;
  std::vector<Attribute> attributes = {};

  // Pixels of the display window that the data window has; the extent is not positive where there are none.
  ImageWindow shown() const;
};

struct ChannelPlace {
  int part = 0;
  int channel = 0;  // index in that part

  friend bool operator==(const ChannelPlace&, const ChannelPlace&) = default;
};

struct ImageHeader {
  std::vector<ImagePart> parts;    // at least one
  std::vector<std::string> views;  // the attribute multiView

  // By its own name, or as "PART.CHANNEL".
  bool is_called(ChannelPlace place, std::string_view name) const;
  std::vector<ChannelPlace> places_of(std::string_view name) const;  // of all parts, in their order
  std::optional<ChannelPlace> find(std::string_view name) const;     // the first of them
  const HeaderChannel& at(ChannelPlace place) const { return parts[place.part].channels[place.channel]; }
  // The part's, else the first part's; null when there is none.
  const Attribute* attribute(std::string_view name, int part = 0) const;
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

// Makes interleaved RGBA linear in place; alpha stays.
using ColourCurve = std::function<void(std::span<float> rgba)>;

namespace backend {

// The curve of a colour space to linear Rec. 709; empty where the library does not know it. And those that it knows.
ColourCurve curve_to_linear(const std::string& space);
std::vector<std::string> colour_spaces();

// What the library behind the headers does with an open file. Both functions throw std::exception with the reason.
class ImageFile {
 public:
  static std::unique_ptr<ImageFile> open(const std::string& path);
  virtual ~ImageFile() = default;
  virtual void read(std::span<const ChannelTarget> targets) = 0;

  ImageHeader header;
};

}  // namespace backend

// One open file. Move-only; one thread at a time.
class ImageReader {
 public:
  // Errors: kIoFailure for a file that is missing, damaged or of a format that is not known, and for a picture that
  // would come out as another one: turned, in CMYK or Lab.
  static Result<ImageReader> open(const std::string& path);

  const ImageHeader& header() const { return file_->header; }

  // Reads the channels, each file block once for each of their parts. Beside the targets a thread takes a band of rows
  // (64; 256 of DWAB; a row of tiles) with all channels of the file from the first to the last wanted one. Texels of
  // the display window that the data window does not cover stay as they are. Errors: kIoFailure for a damaged file; the
  // targets then hold anything.
  Status read(std::span<const ChannelTarget> targets);

 private:
  explicit ImageReader(const std::string& path) : path_(path) {}

  std::string path_;
  std::unique_ptr<backend::ImageFile> file_;
};

// Sets the number of threads that work inside one file, for the process; 1: the caller's alone.
void set_image_threads(int threads);

// Checks whether a file holds all of its pixels, from its size and its tables of offsets alone. Reads the headers and
// the tables of all parts, and no pixels: well under a millisecond. JPEG and PNG must end as their formats have it.
// DPX, WebP, binary portable maps, and BMP and TGA without compression must have the size that follows from their
// headers, and TIFF all strips or tiles of its first picture. It accepts other formats, and compressions that it does
// not know. Errors: kIoFailure where blocks (scanlines or tiles) were never written or lie beyond the file's end: a
// copy or a renderer that was broken off; and for a path that is no file. One sentence that names `path`. Thread-safe.
// Source: "OpenEXR File Layout", OpenEXR documentation.
Status check_whole(const std::string& path);

}  // namespace quincunx::tools
