// SPDX-License-Identifier: MIT
#include "tools/image/display_light.h"

#include <ImathMatrix.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string_view>

#include "tools/program/lower_case.h"

namespace quincunx::tools {
namespace {

// NaN counts as 0, as everywhere.
float finite(float light) {
  return std::isnan(light) ? 0.0f : std::clamp(light, -kLargestHalf, kLargestHalf);
}

float curve(ToneMap tone_map, float light) {
  const float x = std::max(finite(light), 0.0f);
  switch (tone_map) {
    case ToneMap::kReinhard:
      return x / (1 + x);
    case ToneMap::kAces:
      return std::min(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 1.0f);
    case ToneMap::kClamp:
      break;
  }
  return std::min(x, 1.0f);
}

template <typename Function>
std::vector<float> with_colours(std::span<const float> rgba, const Function& function) {
  std::vector<float> result(rgba.begin(), rgba.end());
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (i % 4 != 3) result[i] = function(result[i]);
  }
  return result;
}

}  // namespace

float linear_of_srgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float srgb_of_linear(float light) {
  const float x = std::clamp(light, 0.0f, 1.0f);
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}

std::vector<float> display_light(std::span<const float> rgba, ToneMap tone_map, float exposure) {
  return with_colours(rgba, [&](float light) { return curve(tone_map, light * exposure); });
}

std::vector<float> light_before_reinhard(std::span<const float> rgba) {
  return with_colours(rgba, [](float shown) {
    const float x = std::clamp(shown, 0.0f, kLargestHalf / (1 + kLargestHalf));
    return x / (1 - x);
  });
}

namespace {

using Imath::M33d, Imath::V3d;  // vectors are rows

V3d primary(double x, double y) {
  return {x, y, 1 - x - y};
}

V3d white_of(const Chromaticities& c) {
  return primary(double{c[6]}, double{c[7]}) / double{c[7]};
}

M33d primaries_of(const Chromaticities& c) {
  M33d rows;
  for (int i = 0; i < 3; ++i) {
    const V3d row = primary(double{c[2 * i]}, double{c[2 * i + 1]});
    std::copy_n(&row.x, 3, rows[i]);
  }
  return rows;
}

// NaN spans nothing.
bool span_colours(const Chromaticities& c) {
  constexpr double kLeast = 1e-6;
  return std::abs(primaries_of(c).determinant()) > kLeast && c[7] > 0;
}

// From linear RGB to XYZ, of a white of luminance 1.
M33d to_xyz(const Chromaticities& c) {
  M33d rows = primaries_of(c);
  const V3d amounts = white_of(c) * rows.inverse();
  for (int i = 0; i < 9; ++i)
    rows[i / 3][i % 3] *= amounts[i / 3];
  return rows;
}

// From other primaries to those of Rec. 709, and from their white to its (Bradford's adaptation).
std::array<float, 9> to_rec709(const Chromaticities& from) {
  const M33d bradford(.8951, -.7502, .0389, .2664, 1.7135, -.0685, -.1614, .0367, 1.0296);
  const V3d was = white_of(from) * bradford, is = white_of(kRec709) * bradford;
  const M33d gain(is.x / was.x, 0, 0, 0, is.y / was.y, 0, 0, 0, is.z / was.z);
  const M33d all = to_xyz(from) * bradford * gain * bradford.inverse() * to_xyz(kRec709).inverse();
  std::array<float, 9> columns{};
  for (int i = 0; i < 9; ++i)
    columns[static_cast<std::size_t>(i)] = static_cast<float>(all[i % 3][i / 3]);
  return columns;
}

bool are_rec709(const Chromaticities& c) {
  constexpr float kAsGood = .001f;  // files round them
  return std::equal(c.begin(), c.end(), kRec709.begin(),
                    [](float a, float b) { return std::abs(a - b) <= kAsGood; });
}

// Linear spaces by their primaries, whatever a configuration calls them.
struct LinearSpace {
  std::vector<std::string> names;  // the first is the usual one
  Chromaticities primaries;
};
const std::vector<LinearSpace>& linear_spaces() {
  static const std::vector<LinearSpace> spaces = {
      {{"linear", "scene_linear", "lin_rec709", "lin_srgb", "lin_rec709_scene"}, kRec709},
      {{"ACEScg", "lin_ap1", "lin_ap1_scene"}, {.713f, .293f, .165f, .83f, .128f, .044f, .32168f, .33767f}},
      {{"ACES2065-1", "lin_ap0", "lin_ap0_scene"}, {.7347f, .2653f, 0, 1, .0001f, -.077f, .32168f, .33767f}},
      {{"lin_rec2020", "lin_rec2020_scene"}, {.708f, .292f, .17f, .797f, .131f, .046f, .3127f, .329f}},
      {{"lin_p3d65", "lin_p3d65_scene"}, {.68f, .32f, .265f, .69f, .15f, .06f, .3127f, .329f}}};
  return spaces;
}

template <typename Decode>
ColourCurve each_colour(Decode decode) {
  return [decode](std::span<float> rgba) {
    for (std::size_t i = 0; i < rgba.size(); ++i)
      if (i % 4 != 3) rgba[i] = decode(rgba[i]);
  };
}

// Kodak's printing density: code values 95 and 685 of 1023 are black and white.
// Source: Kennel, "Conversion of 10-bit Log Film Data to 8-bit Linear or Video Data", Kodak, 1995.
float linear_of_kodak_log(float code) {
  const auto light = [](float value) { return std::pow(10.f, (value * 1023 - 685) * .002f / .6f); };
  const float black = light(95.f / 1023);
  return (light(code) - black) / (1 - black);
}

// Nothing where nobody knows the space.
ColourCurve curve_of(const std::string& name) {
  constexpr std::string_view kGamma = "gamma";
  constexpr float kMostGamma = 10;  // gamma22 is a space of somebody's
  const std::string lower = in_lower_case(name);
  if (lower == "srgb" || lower == "srgb_rec709_scene") return each_colour(linear_of_srgb);
  if (lower.starts_with(kGamma)) {
    float gamma = 0;
    const char* const end = lower.data() + lower.size();
    const auto [rest, error] = std::from_chars(lower.data() + kGamma.size(), end, gamma);
    if (error != std::errc()) return {};  // OpenImageIO would take any word for a number
    if (rest == end && gamma > 0 && gamma < kMostGamma)
      return each_colour([gamma](float code) { return code > 0 ? std::pow(code, gamma) : 0; });
  }
  if (lower == "kodaklog" || lower == "cineon") return each_colour(linear_of_kodak_log);
  return backend::curve_to_linear(name);
}

// The names that begin as this one does, or all.
std::string near_names(const std::string& name) {
  std::vector<std::string> names = {"linear",    "ACEScg", "ACES2065-1", "lin_rec2020",
                                    "lin_p3d65", "sRGB",   "KodakLog"};
  for (const std::string& more : backend::colour_spaces())
    if (std::find(names.begin(), names.end(), more) == names.end()) names.push_back(more);
  const std::string begin = in_lower_case(name.substr(0, 3));
  std::vector<std::string> near;
  std::copy_if(names.begin(), names.end(), std::back_inserter(near),
               [&](const std::string& one) { return in_lower_case(one).starts_with(begin); });
  return fmt::format("{}", fmt::join(near.empty() ? names : near, ", "));
}

}  // namespace

Result<InputColour> InputColour::of(const std::string& path, const ImagePart& part,
                                    const std::string& named) {
  InputColour colour;
  colour.straight_ = part.straight_alpha;
  colour.gain_ = part.gain;
  if (named.empty()) colour.unapplied_ = part.unapplied;
  colour.name_ = named.empty() ? part.colour_space : named;
  const std::string lower = in_lower_case(colour.name_);
  for (const LinearSpace& space : linear_spaces()) {
    const bool named_so = std::any_of(space.names.begin(), space.names.end(),
                                      [&](const std::string& one) { return in_lower_case(one) == lower; });
    if (!named_so) continue;
    const bool told = named.empty() && part.chromaticities && are_rec709(space.primaries);
    const Chromaticities& primaries = told ? *part.chromaticities : space.primaries;
    if (are_rec709(primaries)) return colour;
    if (!span_colours(primaries))
      return Status::io(
          fmt::format("'{}' has chromaticities {:.4g} that span no colours; say --input-colour NAME", path,
                      fmt::join(primaries, " ")));
    colour.matrix_ = to_rec709(primaries);
    if (told) colour.name_ = fmt::format("linear, of chromaticities {:.4g}", fmt::join(primaries, " "));
    for (const LinearSpace& known : linear_spaces())
      if (told && known.primaries == primaries) colour.name_ = known.names[0];
    return colour;
  }
  colour.curve_ = curve_of(colour.name_);
  if (colour.curve_) return colour;
  if (named.empty()) {
    return Status::io(
        fmt::format("'{}' has colour of the space '{}', which is not known here; --input-colour takes {}",
                    path, colour.name_, near_names(colour.name_)));
  }
  return Status::invalid(fmt::format("--input-colour: there is no colour space '{}' here; near ones: {}",
                                     named, near_names(named)));
}

std::string InputColour::name() const {
  std::string text = name_;
  if (has_gain()) text += fmt::format(", times {:.4g}", fmt::join(gain_, " "));
  if (!unapplied_.empty()) text += fmt::format(" (its {} is not applied)", unapplied_);
  return text;
}

void InputColour::apply(std::span<float> rgba) const {
  if (curve_) curve_(rgba);
  if (!matrix_ && !straight_ && !has_gain()) return;
  for (std::size_t i = 0; i + 3 < rgba.size(); i += 4) {
    float* c = &rgba[i];
    for (std::size_t j = 0; j < 3; ++j)
      c[j] *= gain_[j];
    if (matrix_) {
      const auto& m = *matrix_;
      const float r = finite(c[0]), g = finite(c[1]), b = finite(c[2]);
      for (std::size_t j = 0; j < 3; ++j)
        c[j] = m[3 * j] * r + m[3 * j + 1] * g + m[3 * j + 2] * b;
    }
    for (std::size_t j = 0; j < 3 && straight_; ++j)
      c[j] *= c[3];
  }
}

}  // namespace quincunx::tools
