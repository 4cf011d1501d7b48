// SPDX-License-Identifier: MIT
// image_io.h and image_reader.h by OpenImageIO.
//
// Beside it OpenEXR's library is used nowhere but in image_openexr.cpp. Its half is the number format everywhere, and
// check_whole() reads the tables of an EXR by itself. OpenImageIO cannot read subsampled channels (luminance and
// chroma): it refuses such a file.
#include <OpenImageIO/color.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/parallel.h>
#include <OpenImageIO/strutil.h>
#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "tools/image/image_io.h"
#include "tools/image/image_openimageio_header.h"
#include "tools/image/image_reader.h"

namespace quincunx::tools {
namespace {

using OIIO::TypeDesc;
using Base = TypeDesc::BASETYPE;

// Debian's build tells on stderr of every attribute that a format has no place for.
[[maybe_unused]] const bool quiet = OIIO::attribute("debug", 0);

// Texels of a row from one place to another, which differ in type or stride.
struct Row {
  const std::byte* from = nullptr;
  std::size_t from_stride = 0;
  std::byte* to = nullptr;
  std::size_t to_stride = 0;
  int count = 0;
};

template <std::size_t kBytes>
void copy(Row row) {
  for (; row.count > 0; --row.count, row.from += row.from_stride, row.to += row.to_stride)
    std::memcpy(row.to, row.from, kBytes);
}

template <typename From, typename To>
void convert(Row row) {
  for (; row.count > 0; --row.count, row.from += row.from_stride, row.to += row.to_stride) {
    From value;
    std::memcpy(&value, row.from, sizeof value);
    float number = static_cast<float>(value);
    if constexpr (sizeof(From) < 4 && std::is_integral_v<From>) number /= std::numeric_limits<From>::max();
    const To converted(number);
    std::memcpy(row.to, &converted, sizeof converted);
  }
}

using RowFunction = void (*)(Row);

// Returns what copies `count` neighbouring channels of one type.
RowFunction copier(std::size_t bytes) {
  switch (bytes) {
    case 2:
      return copy<2>;
    case 4:
      return copy<4>;
    case 6:
      return copy<6>;
    case 8:
      return copy<8>;
    case 12:
      return copy<12>;
    default:
      return copy<16>;
  }
}

template <typename To>
RowFunction converter_to(Base from) {
  switch (from) {
    case TypeDesc::UINT8:
      return convert<std::uint8_t, To>;
    case TypeDesc::UINT16:
      return convert<std::uint16_t, To>;
    case TypeDesc::UINT32:
      return convert<std::uint32_t, To>;
    case TypeDesc::HALF:
      return convert<half, To>;
    case TypeDesc::FLOAT:
      return convert<float, To>;
    case TypeDesc::DOUBLE:
      return convert<double, To>;
    default:
      return nullptr;
  }
}

RowFunction converter(Base from, ChannelType to) {
  return to == ChannelType::kHalf ? converter_to<half>(from) : converter_to<float>(from);
}

Base base_of(ChannelType type) {
  return type == ChannelType::kHalf ? TypeDesc::HALF : TypeDesc::FLOAT;
}

// How neighbouring channels of a part get to where they belong.
struct Run {
  int first = 0;                      // channel in the file
  std::size_t offset = 0, bytes = 0;  // in a pixel of a band
  Base type = TypeDesc::HALF;
  ChannelTarget target;  // of the first
  RowFunction function = nullptr;
};

// The channels of one part: bands of whole rows of the data window are read with all channels that lie between the
// first and the last one, each block once, and then distributed while they are in the cache.
struct Reading {
  int part = 0;
  int first = 0, last = 0;  // channels; `last` lies beyond
  std::size_t pixel_bytes = 0;
  ImageWindow shown;  // of the part
  std::vector<Run> runs;
};

// Appends to the last run where the channel continues it in the file and in memory.
void add_channel(Reading& reading, const OIIO::ImageSpec& spec, int channel, const ChannelTarget& target) {
  const Base type = Base(spec.channelformat(channel).basetype);
  const std::size_t bytes = spec.channelformat(channel).size();
  const bool same = type == base_of(target.type);
  if (!reading.runs.empty() && same) {
    Run& last = reading.runs.back();
    const bool follows = last.type == type && last.target.type == target.type &&
                         last.target.pixel_stride == target.pixel_stride &&
                         last.target.row_stride == target.row_stride && last.bytes < 4 * bytes &&
                         last.first + static_cast<int>(last.bytes / bytes) == channel &&
                         static_cast<std::byte*>(last.target.data) + last.bytes == target.data;
    if (follows) {
      last.bytes += bytes;
      last.function = copier(last.bytes);
      return;
    }
  }
  reading.runs.push_back({.first = channel,
                          .offset = spec.pixel_bytes(reading.first, channel, true),
                          .bytes = bytes,
                          .type = type,
                          .target = target,
                          .function = same ? copier(bytes) : converter(type, target.type)});
}

using Specs = std::vector<OIIO::ImageSpec>;  // one for each part

std::vector<Reading> readings_of(std::span<const ChannelTarget> targets, const ImageHeader& header,
                                 const Specs& specs) {
  struct Wanted {
    int part = 0, channel = 0;  // as the file counts
    ChannelTarget target;
  };
  std::vector<Wanted> wanted;
  for (const ChannelTarget& target : targets) {
    const OIIO::ImageSpec& spec = specs[static_cast<std::size_t>(target.from.part)];
    wanted.push_back({target.from.part, spec.channelindex(header.at(target.from).name), target});
  }
  std::stable_sort(wanted.begin(), wanted.end(), [](const Wanted& a, const Wanted& b) {
    return std::tuple(a.part, a.channel) < std::tuple(b.part, b.channel);
  });
  std::vector<Reading> readings;
  for (const Wanted& one : wanted) {
    if (readings.empty() || readings.back().part != one.part)
      readings.push_back({.part = one.part,
                          .first = one.channel,
                          .shown = header.parts[static_cast<std::size_t>(one.part)].shown(),
                          .runs = {}});
    Reading& reading = readings.back();
    const OIIO::ImageSpec& spec = specs[static_cast<std::size_t>(one.part)];
    add_channel(reading, spec, one.channel, one.target);
    reading.last = one.channel + 1;
    reading.pixel_bytes = spec.pixel_bytes(reading.first, reading.last, true);
  }
  return readings;
}

std::unique_ptr<OIIO::ImageInput> open_input(const std::string& path) {
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // whoever decodes colour multiplies it
  return OIIO::ImageInput::open(path, &config);
}

std::byte* place_in(const ChannelTarget& target, const OIIO::ImageSpec& spec, int x, int y) {
  return static_cast<std::byte*>(target.data) +
         static_cast<std::size_t>(y - spec.full_y) * target.row_stride +
         static_cast<std::size_t>(x - spec.full_x) * target.pixel_stride;
}

// Whether a band in the file's order is what the only target holds.
bool goes_straight(const Reading& reading, const OIIO::ImageSpec& spec) {
  if (reading.runs.size() != 1 || spec.tile_width != 0) return false;
  const Run& run = reading.runs.front();
  return run.type == base_of(run.target.type) && run.bytes == reading.pixel_bytes &&
         run.target.pixel_stride == run.bytes && spec.x == spec.full_x && spec.width == spec.full_width &&
         run.target.row_stride == run.bytes * static_cast<std::size_t>(spec.width);
}

std::string read_band(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const Reading& reading, int begin,
                      int end, void* band) {
  const bool done = spec.tile_width == 0
                        ? input.read_scanlines(reading.part, 0, begin, end, 0, reading.first, reading.last,
                                               TypeDesc::UNKNOWN, band)
                        : input.read_tiles(reading.part, 0, spec.x, spec.x + spec.width, begin, end, 0, 1,
                                           reading.first, reading.last, TypeDesc::UNKNOWN, band);
  if (done && !input.has_error()) return {};  // libraries go on over much that is broken, with a warning
  const std::string why = input.geterror();
  return why.empty() ? "pixels are missing or broken" : why;
}

void distribute(const std::byte* band, int band_top, const OIIO::ImageSpec& spec, const Reading& reading,
                int top, int bottom) {
  const ImageWindow& shown = reading.shown;
  for (int y = top; y < bottom; ++y) {
    const std::byte* row =
        band + (static_cast<std::size_t>(y - band_top) * static_cast<std::size_t>(spec.width) +
                static_cast<std::size_t>(shown.x - spec.x)) *
                   reading.pixel_bytes;
    for (const Run& run : reading.runs) {
      run.function({row + run.offset, reading.pixel_bytes, place_in(run.target, spec, shown.x, y),
                    run.target.pixel_stride, shown.extent.width});
    }
  }
}

// Rows of a band: a whole number of any compression's blocks, or of tiles.
int band_rows(const OIIO::ImageSpec& spec) {
  constexpr int kRows = 64, kRowsOfDwab = 256;
  if (spec.tile_width != 0) return spec.tile_height;
  return spec["compression"].get() == "dwab" ? kRowsOfDwab : kRows;
}

// Reads the bands from `first` on, up to `last`. Returns why not, or nothing.
std::string read_bands(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const Reading& reading,
                       int first, int last) {
  const ImageWindow& shown = reading.shown;
  const bool straight = goes_straight(reading, spec);
  const int rows = band_rows(spec);
  std::vector<std::byte> band(straight ? 0
                                       : reading.pixel_bytes * static_cast<std::size_t>(spec.width) *
                                             static_cast<std::size_t>(rows));
  for (int i = first; i < last; ++i) {
    const int begin = spec.y + i * rows, end = std::min(begin + rows, spec.y + spec.height);
    const int top = std::max(begin, shown.y), bottom = std::min(end, shown.y + shown.extent.height);
    if (top >= bottom) continue;
    if (straight) {
      void* to = place_in(reading.runs.front().target, spec, shown.x, top);
      if (auto why = read_band(input, spec, reading, top, bottom, to); !why.empty()) return why;
      continue;
    }
    if (auto why = read_band(input, spec, reading, begin, end, band.data()); !why.empty()) return why;
    distribute(band.data(), begin, spec, reading, top, bottom);
  }
  return {};
}

std::string with_advice(const std::string& why) {
  if (!OIIO::Strutil::contains(why, "Subsampled")) return why;
  return fmt::format("{}; render it at full size", OIIO::Strutil::strip(why.substr(0, why.find('\n')), "."));
}

class File : public backend::ImageFile {
 public:
  explicit File(const std::string& path) : path_(path), input_(open_input(path)) {
    if (!input_) throw std::runtime_error(with_advice(OIIO::geterror()));
    if (input_->has_error()) throw std::runtime_error(input_->geterror());  // of what is decoded at once
    is_exr_ = std::string_view(input_->format_name()) == "openexr";
    const int count = is_exr_ ? std::max(input_->spec()["oiio:subimages"].get(1), 1) : 1;
    for (int i = 0; i < count; ++i) {
      if (!input_->seek_subimage(i, 0)) throw std::runtime_error(with_advice(input_->geterror()));
      OIIO::ImageSpec spec = input_->spec();
      if (spec.nchannels == 2 && spec.alpha_channel == 1) spec.channelnames[0] = "Y";
      header.parts.push_back(oiio::describe(spec, input_->format_name(), path));
      specs_.push_back(std::move(spec));
    }
    if (const auto* views = specs_.front().find_attribute("multiView"); views && is_exr_)
      for (int i = 0; i < static_cast<int>(views->type().basevalues()); ++i)
        header.views.push_back(views->get_string_indexed(i));
  }

  void read(std::span<const ChannelTarget> targets) override {
    for (const Reading& reading : readings_of(targets, header, specs_)) {
      if (const std::string why = read_part(reading); !why.empty()) throw std::runtime_error(why);
    }
  }

 private:
  // An EXR is read by several threads, each with an input and bands of its own. Other formats are read in order.
  std::string read_part(const Reading& reading) {
    const OIIO::ImageSpec& spec = specs_[static_cast<std::size_t>(reading.part)];
    for (const Run& run : reading.runs)
      if (run.function == nullptr) return "it holds numbers of a type that is not known";
    const ImageWindow& shown = reading.shown;
    if (shown.extent.width < 1 || shown.extent.height < 1) return {};
    const int rows = band_rows(spec);
    const int first = (shown.y - spec.y) / rows,
              last = (shown.y + shown.extent.height - 1 - spec.y) / rows + 1;
    constexpr int kLeastBands = 4;  // fewer are not worth another input
    const int threads =
        is_exr_ ? std::min(OIIO::get_int_attribute("threads", 1), (last - first) / kLeastBands) : 1;
    if (threads <= 1) return read_bands(*input_, spec, reading, first, last);
    std::mutex mutex;
    std::string why;
    const auto begin_of = [&](std::int64_t thread) {
      return first + static_cast<int>((last - first) * thread / threads);
    };
    const auto read_some = [&](std::int64_t thread) {
      std::string problem;
      try {  // what a thread of the pool throws nobody catches
        const auto own = open_input(path_);
        problem =
            own ? read_bands(*own, spec, reading, begin_of(thread), begin_of(thread + 1)) : OIIO::geterror();
      } catch (const std::exception& thrown) {
        problem = thrown.what();
      }
      const std::lock_guard lock(mutex);
      if (!problem.empty()) why = std::move(problem);
    };
    OIIO::parallel_for(std::int64_t{0}, std::int64_t{threads}, read_some);
    return why;
  }

  std::string path_;
  std::unique_ptr<OIIO::ImageInput> input_;
  bool is_exr_ = false;
  Specs specs_;
};

}  // namespace

namespace {

const OIIO::ColorConfig& colours() {
  static const OIIO::ColorConfig config;
  return config;
}

}  // namespace

ColourCurve backend::curve_to_linear(const std::string& space) {
  // Linear Rec. 709 as configurations call it; `linear` alone is the space of an ACES configuration's scenes.
  for (const char* linear : {"lin_rec709", "lin_srgb", "Linear Rec.709 (sRGB)", "linear"}) {
    auto processor = colours().createColorProcessor(space, linear);
    if (!processor) continue;
    return [processor](std::span<float> rgba) {
      const auto pixels = static_cast<int>(rgba.size() / 4);
      constexpr auto kTexel = 4 * sizeof(float);
      processor->apply(rgba.data(), pixels, 1, 3, sizeof(float), kTexel,
                       kTexel * static_cast<std::size_t>(pixels));
    };
  }
  return {};
}

std::vector<std::string> backend::colour_spaces() {
  return colours().getColorSpaceNames();
}

void set_image_threads(int threads) {
  OIIO::attribute("threads", threads);
  OIIO::attribute("exr_threads", threads > 1 ? threads : -1);
}

namespace backend {
namespace {

// Opens an output into memory. Returns why it cannot, or nothing.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& ending) : output_(OIIO::ImageOutput::create("memory" + ending)) {}

  template <typename Write>
  Result<Bytes> write(OIIO::ImageSpec spec, const Write& write_pixels) {
    if (!output_) return Status::io(OIIO::geterror());
    // Some formats date a file by themselves; an attribute that is no text keeps them from it.
    if (spec.find_attribute("DateTime") == nullptr) spec.attribute("DateTime", 0);
    if (!output_->set_ioproxy(&memory_) || !output_->open("memory", spec) || !write_pixels(*output_) ||
        !output_->close())
      return Status::io(output_->geterror());
    return std::move(bytes_);
  }

 private:
  Bytes bytes_;
  OIIO::Filesystem::IOVecOutput memory_{bytes_};
  std::unique_ptr<OIIO::ImageOutput> output_;  // last: it writes as it closes
};

}  // namespace

std::unique_ptr<ImageFile> ImageFile::open(const std::string& path) {
  return std::make_unique<File>(path);
}

std::span<const Ending> written_endings() {
  static constexpr Ending kEndings[] = {{".exr", FileFormat::kExr},   {".tif", FileFormat::kTiff},
                                        {".tiff", FileFormat::kTiff}, {".hdr", FileFormat::kHdr},
                                        {".png", FileFormat::kPng},   {".jpg", FileFormat::kJpeg},
                                        {".jpeg", FileFormat::kJpeg}, {".dpx", FileFormat::kDpx}};
  return kEndings;
}

Result<Bytes> encode(FileFormat format, const Texels& texels, std::span<const Attribute> attributes) {
  const bool light = texels.depth == Depth::kFloat;
  const TypeDesc type = light                        ? TypeDesc::FLOAT
                        : texels.depth == Depth::k16 ? TypeDesc::UINT16
                                                     : TypeDesc::UINT8;
  OIIO::ImageSpec spec(texels.extent.width, texels.extent.height, texels.channels, type);
  // A TIFF would say it in a directory that cannot be written to memory; without it, codes count as sRGB.
  if (format != FileFormat::kTiff) spec.attribute("oiio:ColorSpace", light ? "Linear" : "sRGB");
  if (!light) spec.attribute("oiio:UnassociatedAlpha", 1);
  for (const Attribute& attribute : attributes)
    oiio::set_attribute(spec, {oiio::own_name(attribute.name), attribute.value});
  constexpr int kUp = 0x10, kAll = 0xf8;  // filters of a PNG; of the fast ones the first is no larger
  spec.attribute("png:compressionLevel", texels.small ? 9 : 1);
  spec.attribute("png:filter", texels.small ? kAll : kUp);
  if (format == FileFormat::kDpx) spec.attribute("oiio:BitsPerSample", 10);
  if (format == FileFormat::kJpeg) {
    spec.attribute("compression", "jpeg:95");
    spec.attribute("jpeg:subsampling", "4:4:4");
  }
  const auto known = std::find_if(written_endings().begin(), written_endings().end(),
                                  [format](const Ending& ending) { return ending.format == format; });
  return MemoryFile(std::string(known->text)).write(spec, [&](OIIO::ImageOutput& output) {
    return output.write_image(type, texels.data, static_cast<OIIO::stride_t>(texels.pixel_stride),
                              static_cast<OIIO::stride_t>(texels.row_stride));
  });
}

Result<Bytes> encode_exr(Extent extent, std::span<const Channel> channels,
                         std::span<const Attribute> attributes) {
  OIIO::ImageSpec spec(extent.width, extent.height, static_cast<int>(channels.size()), TypeDesc::HALF);
  spec.channelnames.clear();
  for (const Channel& channel : channels) {
    spec.channelnames.push_back(channel.name);
    spec.channelformats.emplace_back(base_of(channel.stored));
  }
  spec.attribute("compression", "zip");
  for (const Attribute& attribute : attributes)
    oiio::set_attribute(spec, attribute);

  // A band holds whole blocks for many threads, and not more than OpenImageIO writes at once.
  constexpr int kBlock = 16;
  constexpr std::size_t kBandBytes = 16 << 20;
  const std::size_t pixel = spec.pixel_bytes(true), row = pixel * static_cast<std::size_t>(extent.width);
  const int rows = std::min(std::max(static_cast<int>(kBandBytes / row) / kBlock, 1) * kBlock, extent.height);
  std::vector<std::byte> band(row * static_cast<std::size_t>(rows));
  const auto gather = [&](int y, std::byte* to) {
    for (const Channel& channel : channels) {
      const RowFunction function = channel.type == channel.stored
                                       ? copier(bytes_of(channel.type))
                                       : converter(base_of(channel.type), channel.stored);
      function(
          {static_cast<const std::byte*>(channel.data) + static_cast<std::size_t>(y) * channel.row_stride,
           channel.pixel_stride, to, pixel, extent.width});
      to += bytes_of(channel.stored);
    }
  };
  return MemoryFile(".exr").write(spec, [&](OIIO::ImageOutput& output) {
    for (int top = 0; top < extent.height; top += rows) {
      const int bottom = std::min(top + rows, extent.height);
      OIIO::parallel_for(std::int64_t{top}, std::int64_t{bottom}, [&](std::int64_t y) {
        gather(static_cast<int>(y), band.data() + static_cast<std::size_t>(y - top) * row);
      });
      if (!output.write_scanlines(top, bottom, 0, TypeDesc::UNKNOWN, band.data())) return false;
    }
    return true;
  });
}

}  // namespace backend
}  // namespace quincunx::tools
