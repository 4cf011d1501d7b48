// SPDX-License-Identifier: MIT
// image_io.h and image_reader.h by OpenEXR and libpng, for programs that carry their libraries with them.
#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfTestFile.h>
#include <ImfThreading.h>
#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <utility>

#include "tools/image/image_io.h"
#include "tools/image/image_reader.h"

namespace quincunx::tools {
namespace {

// Rows that are read at once where the data window is wider than the display window.
constexpr int kBandRows = 64;

Imf::PixelType type_of(ChannelType type) {
  return type == ChannelType::kHalf ? Imf::HALF : Imf::FLOAT;
}

struct AttributeWriter {
  Imf::Header& header;
  const std::string& name;

  void operator()(const std::string& value) const { insert(value); }
  void operator()(int value) const { insert(value); }
  void operator()(float value) const { insert(value); }
  void operator()(const Vec2& value) const { insert(Imath::V2f(value.x, value.y)); }
  void operator()(const Rational& value) const {
    insert(Imf::Rational(value.numerator, static_cast<unsigned>(value.denominator)));
  }
  void operator()(const Matrix& value) const {
    Imath::M44f matrix;
    std::memcpy(matrix.getValue(), value.data(), sizeof value);
    insert(matrix);
  }
  void operator()(const Chromaticities& v) const {
    insert(Imf::Chromaticities({v[0], v[1]}, {v[2], v[3]}, {v[4], v[5]}, {v[6], v[7]}));
  }
  void operator()(const TimeCode& value) const { insert(Imf::TimeCode(value.time, value.user)); }

  template <typename Value>
  void insert(const Value& value) const {
    header.insert(name, Imf::TypedAttribute<Value>(value));
  }
};

// The attribute's value, if it is of this type.
template <typename Value>
const Value* as(const Imf::Attribute& attribute) {
  const auto* typed = dynamic_cast<const Imf::TypedAttribute<Value>*>(&attribute);
  return typed != nullptr ? &typed->value() : nullptr;
}

std::optional<AttributeValue> value_of(const Imf::Attribute& attribute) {
  if (const auto* text = as<std::string>(attribute)) return *text;
  if (const auto* number = as<int>(attribute)) return *number;
  if (const auto* number = as<float>(attribute)) return *number;
  if (const auto* number = as<double>(attribute)) return static_cast<float>(*number);
  if (const auto* pair = as<Imath::V2f>(attribute)) return Vec2{pair->x, pair->y};
  if (const auto* pair = as<Imath::V2d>(attribute))
    return Vec2{static_cast<float>(pair->x), static_cast<float>(pair->y)};
  if (const auto* pair = as<Imath::V2i>(attribute))
    return Vec2{static_cast<float>(pair->x), static_cast<float>(pair->y)};
  if (const auto* ratio = as<Imf::Rational>(attribute)) return Rational{ratio->n, static_cast<int>(ratio->d)};
  if (const auto* of_exr = as<Imath::M44f>(attribute)) {
    Matrix matrix;
    std::memcpy(matrix.data(), of_exr->getValue(), sizeof matrix);
    return matrix;
  }
  if (const auto* of_exr = as<Imath::M44d>(attribute)) {
    Matrix matrix;
    std::copy_n(of_exr->getValue(), matrix.size(), matrix.begin());
    return matrix;
  }
  if (const auto* xy = as<Imf::Chromaticities>(attribute)) {
    return Chromaticities{xy->red.x,  xy->red.y,  xy->green.x, xy->green.y,
                          xy->blue.x, xy->blue.y, xy->white.x, xy->white.y};
  }
  if (const auto* code = as<Imf::TimeCode>(attribute))
    return TimeCode{code->timeAndFlags(), code->userData()};
  return std::nullopt;
}

std::vector<Attribute> attributes_of(const Imf::Header& header) {
  std::vector<Attribute> attributes;
  for (auto found = header.begin(); found != header.end(); ++found) {
    if (auto value = value_of(found.attribute())) attributes.push_back({found.name(), *std::move(value)});
  }
  return attributes;
}

ImageWindow window_of(const Imath::Box2i& box) {
  return {box.min.x, box.min.y, {box.max.x - box.min.x + 1, box.max.y - box.min.y + 1}};
}

ImagePart describe(const Imf::Header& header) {
  ImagePart part;
  part.attributes = attributes_of(header);
  if (header.hasName()) part.name = header.name();
  part.data = window_of(header.dataWindow());
  part.display = window_of(header.displayWindow());
  part.deep = header.hasType() && Imf::isDeepData(header.type());
  part.dwa = header.compression() == Imf::DWAA_COMPRESSION || header.compression() == Imf::DWAB_COMPRESSION;
  if (header.hasView()) part.view = header.view();
  part.pixel_aspect = header.pixelAspectRatio();
  part.colour_space = "linear";
  if (Imf::hasChromaticities(header))
    part.chromaticities = std::get<Chromaticities>(*value_of(Imf::chromaticitiesAttribute(header)));
  for (auto found = header.channels().begin(); found != header.channels().end(); ++found) {
    const Imf::PixelType type = found.channel().type;
    part.channels.push_back({.name = found.name(),
                             .stored = type == Imf::HALF ? ChannelType::kHalf : ChannelType::kFloat,
                             .integer = type == Imf::UINT,
                             .sampling = {found.channel().xSampling, found.channel().ySampling}});
  }
  return part;
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

// Those of one part, each channel once, as OpenEXR takes one place for each: what is wanted twice is read twice.
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
void read_rows(Imf::InputPart& input, const ImagePart& part, const Targets& targets) {
  Imf::FrameBuffer buffer;
  for (const ChannelTarget& target : targets) {
    buffer.insert(part.channels[target.from.channel].name,
                  slice_at(part.display.x, part.display.y, target.type, target.data, target.pixel_stride,
                           target.row_stride));
  }
  input.setFrameBuffer(buffer);
  const ImageWindow shown = part.shown();
  input.readPixels(shown.y, shown.y + shown.extent.height - 1);
}

// By way of whole rows of the data window, for it reaches beyond the display window at the sides.
void read_wide_rows(Imf::InputPart& input, const ImagePart& part, const Targets& targets) {
  const ImageWindow& data = part.data;
  const ImageWindow shown = part.shown();
  const auto width = static_cast<std::size_t>(data.extent.width);
  std::vector<std::byte> planes(targets.size() * sizeof(float) * width * kBandRows);
  const auto plane_of = [&](std::size_t i) { return planes.data() + i * sizeof(float) * width * kBandRows; };
  for (int begin = shown.y; begin < shown.y + shown.extent.height; begin += kBandRows) {
    const int end = std::min(begin + kBandRows, shown.y + shown.extent.height);
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
        const std::byte* from = plane_of(i) + ((y - begin) * width + (shown.x - data.x)) * texel;
        std::byte* to = static_cast<std::byte*>(target.data) + (y - part.display.y) * target.row_stride +
                        (shown.x - part.display.x) * target.pixel_stride;
        for (int x = 0; x < shown.extent.width; ++x, from += texel, to += target.pixel_stride)
          std::memcpy(to, from, texel);
      }
    }
  }
}

class ExrFile : public backend::ImageFile {
 public:
  explicit ExrFile(const std::string& path) : file_(path.c_str()) {
    if (Imf::hasMultiView(file_.header(0))) header.views = Imf::multiView(file_.header(0));
    for (int part = 0; part < file_.parts(); ++part)
      header.parts.push_back(describe(file_.header(part)));
  }

  void read(std::span<const ChannelTarget> targets) override {
    for (const Targets& round : rounds_of(targets)) {
      const int index = round.front().from.part;
      const ImagePart& part = header.parts[index];
      const Extent shown = part.shown().extent;
      if (shown.width < 1 || shown.height < 1) continue;
      Imf::InputPart input(file_, index);
      (shown.width < part.data.extent.width ? read_wide_rows : read_rows)(input, part, round);
    }
  }

 private:
  Imf::MultiPartInputFile file_;
};

class PngFile : public backend::ImageFile {  // of 8 bits
 public:
  explicit PngFile(const std::string& path) : path_(path) {
    png_image png = opened();
    const bool colour = (png.format & PNG_FORMAT_FLAG_COLOR) != 0;
    ImagePart part;
    part.data.extent = part.display.extent = {static_cast<int>(png.width), static_cast<int>(png.height)};
    part.colour_space = "sRGB";
    part.straight_alpha = (png.format & PNG_FORMAT_FLAG_ALPHA) != 0;
    png_image_free(&png);
    for (const char* name : colour ? std::vector{"R", "G", "B"} : std::vector{"Y"})
      part.channels.push_back({.name = name, .stored = ChannelType::kFloat});
    if (part.straight_alpha) part.channels.push_back({.name = "A", .stored = ChannelType::kFloat});
    header.parts.push_back(std::move(part));
  }

  void read(std::span<const ChannelTarget> targets) override {
    png_image png = opened();
    std::vector<std::uint8_t> codes(PNG_IMAGE_SIZE(png));
    if (png_image_finish_read(&png, nullptr, codes.data(), 0, nullptr) == 0)
      throw std::runtime_error(png.message);
    const std::size_t count = header.parts[0].channels.size();
    for (const ChannelTarget& target : targets) {
      for (std::size_t i = 0; i < codes.size() / count; ++i) {
        const float value =
            static_cast<float>(codes[i * count + static_cast<std::size_t>(target.from.channel)]) / 255;
        const half small(value);
        std::byte* to = static_cast<std::byte*>(target.data) + i / png.width * target.row_stride +
                        i % png.width * target.pixel_stride;
        if (target.type == ChannelType::kHalf)
          std::memcpy(to, &small, sizeof small);
        else
          std::memcpy(to, &value, sizeof value);
      }
    }
  }

 private:
  png_image opened() const {
    png_image png = {};
    png.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_file(&png, path_.c_str()) == 0)
      throw std::runtime_error(fmt::format("it is no EXR and no good PNG ({})", png.message));
    png.format &= PNG_FORMAT_FLAG_ALPHA | PNG_FORMAT_FLAG_COLOR;
    return png;
  }

  std::string path_;
};

}  // namespace

// This build knows the curve of PNG, and no other by a library.
ColourCurve backend::curve_to_linear(const std::string&) {
  return {};
}

std::vector<std::string> backend::colour_spaces() {
  return {};
}

void set_image_threads(int threads) {
  Imf::setGlobalThreadCount(threads > 1 ? threads : 0);
}

namespace backend {
namespace {

void append(png_structp png, png_bytep bytes, std::size_t count) {
  auto& made = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  made.insert(made.end(), bytes, bytes + count);
}

// False where libpng refuses: it then jumps back here, so nothing in this function may have a destructor.
bool write_rows(png_structp png, png_infop info, const Texels& codes) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  constexpr int kColourTypes[] = {0, PNG_COLOR_TYPE_GRAY, 0, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
  png_set_IHDR(png, info, static_cast<png_uint_32>(codes.extent.width),
               static_cast<png_uint_32>(codes.extent.height), 8, kColourTypes[codes.channels],
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  // The frame loop waits for files: level 1 and one filter are 2.5 times faster than all filters, and no larger.
  png_set_compression_level(png, codes.small ? 9 : 1);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, codes.small ? PNG_ALL_FILTERS : PNG_FILTER_UP);
  png_write_info(png, info);
  if (codes.pixel_stride > static_cast<std::size_t>(codes.channels)) png_set_filler(png, 0, PNG_FILLER_AFTER);
  const auto* row = static_cast<const std::uint8_t*>(codes.data);
  for (int y = 0; y < codes.extent.height; ++y, row += codes.row_stride)
    png_write_row(png, row);
  png_write_end(png, info);
  return true;
}

// The channel's texels as a packed plane of the type that the file stores.
template <typename From, typename To>
std::vector<char> converted(const Channel& channel, Extent extent) {
  std::vector<char> plane(static_cast<std::size_t>(extent.area()) * sizeof(To));
  char* to = plane.data();
  for (int y = 0; y < extent.height; ++y) {
    const char* from =
        static_cast<const char*>(channel.data) + static_cast<std::size_t>(y) * channel.row_stride;
    for (int x = 0; x < extent.width; ++x, from += channel.pixel_stride, to += sizeof(To)) {
      From value;
      std::memcpy(&value, from, sizeof value);
      const To stored(value);
      std::memcpy(to, &stored, sizeof stored);
    }
  }
  return plane;
}

}  // namespace

std::unique_ptr<ImageFile> ImageFile::open(const std::string& path) {
  if (Imf::isOpenExrFile(path.c_str())) return std::make_unique<ExrFile>(path);
  return std::make_unique<PngFile>(path);
}

std::span<const Ending> written_endings() {
  static constexpr Ending kEndings[] = {{".exr", FileFormat::kExr}, {".png", FileFormat::kPng}};
  return kEndings;
}

Result<Bytes> encode(FileFormat, const Texels& codes, std::span<const Attribute>) {
  Bytes made;
  bool done = false;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info != nullptr) {
    png_set_write_fn(png, &made, append, nullptr);
    done = write_rows(png, info, codes);
  }
  png_destroy_write_struct(&png, &info);
  if (!done)
    return Status::io("it cannot be encoded");  // libpng says why on stderr: too long a side, or no memory
  return made;
}

Result<Bytes> encode_exr(Extent extent, std::span<const Channel> channels,
                         std::span<const Attribute> attributes) {
  Imf::StdOSStream memory;  // the file's own stream would not tell of a full disk
  try {
    Imf::Header header(extent.width, extent.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer buffer;
    std::vector<std::vector<char>> planes;
    for (const Channel& channel : channels) {
      header.channels().insert(channel.name, Imf::Channel(type_of(channel.stored)));
      char* data = static_cast<char*>(const_cast<void*>(channel.data));  // which is only read
      std::size_t pixel_stride = channel.pixel_stride, row_stride = channel.row_stride;
      if (channel.type != channel.stored) {
        planes.push_back(channel.stored == ChannelType::kHalf ? converted<float, half>(channel, extent)
                                                              : converted<half, float>(channel, extent));
        data = planes.back().data();
        pixel_stride = bytes_of(channel.stored);
        row_stride = pixel_stride * static_cast<std::size_t>(extent.width);
      }
      buffer.insert(channel.name, Imf::Slice(type_of(channel.stored), data, pixel_stride, row_stride));
    }
    for (const Attribute& attribute : attributes)
      std::visit(AttributeWriter{header, attribute.name}, attribute.value);
    Imf::OutputFile file(memory, header);
    file.setFrameBuffer(buffer);
    file.writePixels(extent.height);
  } catch (const std::exception& problem) {
    return Status::io(problem.what());
  }
  const std::string bytes = memory.str();
  return Bytes(bytes.begin(), bytes.end());
}

}  // namespace backend
}  // namespace quincunx::tools
