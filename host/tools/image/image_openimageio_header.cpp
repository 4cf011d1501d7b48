// SPDX-License-Identifier: MIT
#include "tools/image/image_openimageio_header.h"

#include <OpenImageIO/strutil.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace quincunx::tools::oiio {
namespace {

using OIIO::TypeDesc;
using Base = TypeDesc::BASETYPE;

// Attributes: EXR's names, and OpenImageIO's where those are others.
constexpr std::pair<const char*, const char*> kNames[] = {{"worldToCamera", "worldtocamera"},
                                                          {"worldToNDC", "worldtoscreen"},
                                                          {"framesPerSecond", "FramesPerSecond"},
                                                          {"pixelAspectRatio", "PixelAspectRatio"},
                                                          {"owner", "Copyright"},
                                                          {"capDate", "DateTime"},
                                                          {"comments", "ImageDescription"},
                                                          {"timeCode", "smpte:TimeCode"},
                                                          {"expTime", "ExposureTime"},
                                                          {"aperture", "FNumber"}};
const TypeDesc kPairType(TypeDesc::FLOAT, TypeDesc::VEC2);
const TypeDesc kChromaticitiesType(TypeDesc::FLOAT, 8);

std::string exr_name(std::string_view name) {
  for (const auto& [exr, own] : kNames)
    if (OIIO::Strutil::iequals(OIIO::string_view(name.data(), name.size()), own)) return exr;
  return std::string(name);
}

struct AttributeWriter {
  OIIO::ImageSpec& spec;
  const std::string name;

  void operator()(const std::string& value) const { spec.attribute(name, value); }
  void operator()(int value) const { spec.attribute(name, value); }
  void operator()(float value) const { spec.attribute(name, value); }
  void operator()(const Vec2& value) const { spec.attribute(name, kPairType, &value.x); }
  void operator()(const Rational& value) const { spec.attribute(name, OIIO::TypeRational, &value.numerator); }
  void operator()(const Matrix& value) const { spec.attribute(name, OIIO::TypeMatrix44, value.data()); }
  void operator()(const Chromaticities& value) const {
    spec.attribute(name, kChromaticitiesType, value.data());
  }
  void operator()(const TimeCode& value) const { spec.attribute(name, OIIO::TypeTimeCode, &value.time); }
};

template <typename Value>
Value copied(const OIIO::ParamValue& from) {
  Value value;
  std::memcpy(&value, from.data(), sizeof value);
  return value;
}

template <typename Pair>
Vec2 rounded(const Pair& pair) {
  return {static_cast<float>(pair[0]), static_cast<float>(pair[1])};
}

std::optional<AttributeValue> value_of(const OIIO::ParamValue& from) {
  const TypeDesc type = from.type();
  if (type == OIIO::TypeString) return from.get_string();
  if (type == OIIO::TypeInt) return from.get_int();
  if (type == OIIO::TypeFloat || type == TypeDesc(TypeDesc::DOUBLE)) return from.get_float();
  if (type == OIIO::TypeRational) return copied<Rational>(from);
  if (type == OIIO::TypeTimeCode) return copied<TimeCode>(from);
  if (type == OIIO::TypeMatrix44) return copied<Matrix>(from);
  if (type == TypeDesc(TypeDesc::DOUBLE, TypeDesc::MATRIX44)) {
    const auto exact = copied<std::array<double, 16>>(from);
    Matrix matrix;
    std::copy(exact.begin(), exact.end(), matrix.begin());
    return matrix;
  }
  if (type == kChromaticitiesType) return copied<Chromaticities>(from);
  if (type == kPairType) return copied<Vec2>(from);
  if (type == TypeDesc(TypeDesc::DOUBLE, TypeDesc::VEC2)) return rounded(copied<std::array<double, 2>>(from));
  if (type == TypeDesc(TypeDesc::INT, TypeDesc::VEC2)) return rounded(copied<std::array<int, 2>>(from));
  return std::nullopt;
}

std::vector<Attribute> attributes_of(const OIIO::ImageSpec& spec) {
  std::vector<Attribute> attributes;
  for (const OIIO::ParamValue& from : spec.extra_attribs) {
    if (auto value = value_of(from))
      attributes.push_back({exr_name(from.name().string()), *std::move(value)});
  }
  return attributes;
}

bool is_code(Base type) {
  return type == TypeDesc::UINT8 || type == TypeDesc::UINT16;
}

bool is_light(Base type) {
  return type == TypeDesc::HALF || type == TypeDesc::FLOAT || type == TypeDesc::DOUBLE;
}

// Returns why the pixels would not be those that are meant, or nothing.
std::string why_not(const OIIO::ImageSpec& spec) {
  constexpr int kWhiteIsZero = 0, kUpright = 1;
  const Base type = Base(spec.format.basetype);
  if (const int turned = spec["Orientation"].get(kUpright); turned > kUpright)
    return fmt::format("it is stored turned or mirrored (orientation {}); write it upright", turned);
  for (const char* attribute : {"tiff:ColorSpace", "jpeg:ColorSpace"}) {
    const std::string space = spec[attribute].get();
    if (!space.empty() && space != "YCbCr" && (space != "palette" || spec.alpha_channel >= 0))
      return fmt::format("its colour is {}{}; write it as RGB", space,
                         spec.alpha_channel >= 0 ? " with alpha" : "");
  }
  // The library turns codes of 8 bits alone.
  if (spec["tiff:PhotometricInterpretation"].get(-1) == kWhiteIsZero && type != TypeDesc::UINT8)
    return "its white is 0; write black as 0";
  if (is_light(type) && spec["oiio:BitsPerSample"].get(0) == 24)
    return "it holds floats of 24 bits; write 16 or 32";
  return {};
}

// Reads the lines of a Radiance HDR: OpenImageIO knows the last EXPOSURE alone.
// Source: Ward, "Radiance File Formats", 1991.
void add_radiance_lines(const std::string& path, ImagePart& part) {
  std::ifstream file(path);
  std::string line;
  const auto numbers_after = [&line](const char* key, auto numbers) {
    if (!line.starts_with(key)) return std::optional<decltype(numbers)>();
    std::istringstream text(line.substr(std::strlen(key)));
    text.imbue(std::locale::classic());
    for (float& number : numbers)
      text >> number;
    if (!text || std::any_of(numbers.begin(), numbers.end(), [](float n) { return !std::isfinite(n); }))
      throw std::runtime_error(fmt::format("its header has '{}'", line));
    return std::optional(numbers);
  };
  const auto divide = [&](const std::array<float, 3>& by) {
    for (std::size_t i = 0; i < by.size(); ++i) {
      part.gain[i] /= by[i];
      if (!(part.gain[i] > 0 && std::isfinite(part.gain[i])))
        throw std::runtime_error(fmt::format("its header has '{}', which no light can be divided by", line));
    }
  };
  while (std::getline(file, line) && !line.empty()) {
    if (const auto exposure = numbers_after("EXPOSURE=", std::array<float, 1>()))
      divide({(*exposure)[0], (*exposure)[0], (*exposure)[0]});
    if (const auto correction = numbers_after("COLORCORR=", std::array<float, 3>())) divide(*correction);
    if (const auto primaries = numbers_after("PRIMARIES=", Chromaticities())) part.chromaticities = primaries;
  }
}

}  // namespace

ImagePart describe(const OIIO::ImageSpec& spec, const std::string& format, const std::string& path) {
  const bool is_exr = format == "openexr";
  // A PFM is linear, whatever OpenImageIO says of all portable maps.
  const bool is_pfm = format == "pnm" && is_light(Base(spec.format.basetype));
  ImagePart part;
  part.attributes = attributes_of(spec);
  part.name = spec["oiio:subimagename"].get();
  part.data = {spec.x, spec.y, {spec.width, spec.height}};
  part.display = {spec.full_x, spec.full_y, {spec.full_width, spec.full_height}};
  part.deep = spec.deep;
  part.dwa = OIIO::Strutil::starts_with(spec["compression"].get(), "dwa");
  part.view = spec["view"].get();
  part.pixel_aspect = spec["PixelAspectRatio"].get(1.0f);
  part.colour_space = is_code(Base(spec.format.basetype)) ? "sRGB" : "linear";
  if (!is_exr) {  // whose own attributes of these names are another program's remarks
    part.straight_alpha = spec["oiio:UnassociatedAlpha"].get(0) != 0 && spec.alpha_channel >= 0;
    if (!is_pfm) part.colour_space = spec["oiio:ColorSpace"].get(part.colour_space);
    if (const float gamma = spec["oiio:Gamma"].get(0.f); gamma > 0 && part.colour_space.starts_with("Gamma"))
      part.colour_space = fmt::format("Gamma{:.3g}", gamma);
    const std::string profile = spec["ICCProfile:profile_description"].get();
    if (!profile.empty() && !OIIO::Strutil::icontains(profile, "sRGB"))
      part.unapplied = fmt::format("ICC profile '{}'", std::string(OIIO::Strutil::strip(profile)));
    if (const std::string why = why_not(spec); !why.empty()) throw std::runtime_error(why);
  }
  if (const auto* found = spec.find_attribute("chromaticities", kChromaticitiesType))
    part.chromaticities = copied<Chromaticities>(*found);
  if (format == "hdr") add_radiance_lines(path, part);
  for (int c = 0; c < spec.nchannels; ++c) {
    const Base type = Base(spec.channelformat(c).basetype);
    part.channels.push_back({.name = spec.channel_name(c),
                             .stored = type == TypeDesc::HALF ? ChannelType::kHalf : ChannelType::kFloat,
                             .integer = !is_light(type) && !is_code(type)});
  }
  return part;
}

std::string own_name(const std::string& name) {
  for (const auto& [exr, own] : kNames)
    if (name == exr) return own;
  return name;
}

void set_attribute(OIIO::ImageSpec& spec, const Attribute& attribute) {
  std::visit(AttributeWriter{spec, attribute.name}, attribute.value);
}

}  // namespace quincunx::tools::oiio
