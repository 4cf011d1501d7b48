// SPDX-License-Identifier: MIT
#include "tools/image/false_colour.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include <fmt/format.h>

namespace quincunx::tools {
namespace {

constexpr int kLeastWidth = 480;
constexpr int kInset = 12;
constexpr int kTextSize = 14;
constexpr int kTitleBaseline = 22;
constexpr int kBarTop = 32;
constexpr int kScaleHeight = 12;
constexpr int kTickBaseline = 60;
constexpr int kLegendHeight = 70;
constexpr int kWheelSize = 58;

constexpr const char* kSansPath = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr const char* kSansBoldPath = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";

using Ramp = std::array<Rgb, 256>;

Ramp ramp_named(const char* name) {
  Ramp ramp{};
  std::array<float, ramp.size()> places{};
  for (std::size_t i = 0; i < ramp.size(); ++i)
    places[i] = static_cast<float>(i) / static_cast<float>(ramp.size() - 1);
  const int width = static_cast<int>(ramp.size());
  const OIIO::ImageBuf from(OIIO::ImageSpec(width, 1, 1, OIIO::TypeDesc::FLOAT), places.data());
  OIIO::ImageBuf to(OIIO::ImageSpec(width, 1, 3, OIIO::TypeDesc::UINT8), ramp.data());
  OIIO::ImageBufAlgo::color_map(to, from, 0, name);
  return ramp;
}

Ramp grey_ramp() {
  Ramp ramp{};
  for (std::size_t i = 0; i < ramp.size(); ++i)
    ramp[i].r = ramp[i].g = ramp[i].b = static_cast<std::uint8_t>(i);
  return ramp;
}

const Ramp& ramp_of(ColourMap map) {
  static const Ramp grey = grey_ramp(), viridis = ramp_named("viridis"), magma = ramp_named("magma");
  return map == ColourMap::kGrey ? grey : map == ColourMap::kViridis ? viridis : magma;
}

float position(const ScalarScale& scale, float value) {
  if (!scale.logarithmic) return (value - scale.low) / (scale.high - scale.low);
  return std::log(std::max(value, scale.low) / scale.low) / std::log(scale.high / scale.low);
}

float value_at(const ScalarScale& scale, float t) {
  if (!scale.logarithmic) return scale.low + (scale.high - scale.low) * t;
  return scale.low * std::pow(scale.high / scale.low, t);
}

// The picture, magnified, above an empty legend.
template <typename ColourAt>
Canvas canvas_with_legend(Extent extent, const std::string& title, const ColourAt& colour_at) {
  const int factor = std::max(1, (kLeastWidth + extent.width - 1) / extent.width);
  const Extent shown = {extent.width * factor, extent.height * factor};
  Canvas canvas({shown.width, shown.height + kLegendHeight}, kCanvasBackground);
  for (int y = 0; y < extent.height; ++y) {
    for (int x = 0; x < extent.width; ++x) {
      const auto index =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(extent.width) + static_cast<std::size_t>(x);
      canvas.fill(x * factor, y * factor, {factor, factor}, colour_at(index));
    }
  }
  draw_text(canvas, kInset, shown.height + kTitleBaseline, title, kTextSize, Face::kSansBold, kBrightText);
  return canvas;
}

bool is_finite(Vec2 vector) {
  return std::isfinite(vector.x) && std::isfinite(vector.y);
}

}  // namespace

Canvas::Canvas(Extent size, Rgb background) : extent(size), rgb(static_cast<std::size_t>(size.area()) * 3) {
  fill(0, 0, size, background);
}

void Canvas::fill(int x, int y, Extent size, Rgb colour) {
  const int right = std::min(x + size.width, extent.width), bottom = std::min(y + size.height, extent.height);
  for (int row = std::max(y, 0); row < bottom; ++row) {
    std::uint8_t* texel = &rgb[(static_cast<std::size_t>(row) * static_cast<std::size_t>(extent.width) +
                                static_cast<std::size_t>(std::max(x, 0))) *
                               3];
    for (int column = std::max(x, 0); column < right; ++column, texel += 3)
      texel[0] = colour.r, texel[1] = colour.g, texel[2] = colour.b;
  }
}

const char* font_path(Face face) {
  return face == Face::kSans ? kSansPath : kSansBoldPath;
}

bool has_fonts() {
  std::error_code error;
  return std::filesystem::exists(kSansPath, error) && std::filesystem::exists(kSansBoldPath, error);
}

int text_width(const std::string& text, int size_px, Face face) {
  if (text.empty() || !has_fonts()) return 0;
  return OIIO::ImageBufAlgo::text_size(text, size_px, font_path(face)).width();
}

void draw_text(Canvas& canvas, int x, int y, const std::string& text, int size_px, Face face, Rgb colour,
               Align align) {
  if (text.empty() || !has_fonts()) return;
  OIIO::ImageBuf picture(OIIO::ImageSpec(canvas.extent.width, canvas.extent.height, 3, OIIO::TypeDesc::UINT8),
                         canvas.rgb.data());
  const float rgb[] = {static_cast<float>(colour.r) / 255, static_cast<float>(colour.g) / 255,
                       static_cast<float>(colour.b) / 255};
  using OIIO::ImageBufAlgo::TextAlignX;
  OIIO::ImageBufAlgo::render_text(picture, x, y, text, size_px, font_path(face), rgb,
                                  align == Align::kLeft ? TextAlignX::Left : TextAlignX::Right);
}

Rgb colour_of(ColourMap map, float t) {
  const Ramp& ramp = ramp_of(map);
  return ramp[static_cast<std::size_t>(
      std::lround(std::clamp(t, 0.0f, 1.0f) * static_cast<float>(ramp.size() - 1)))];
}

Rgb colour_of(Vec2 vector, float longest) {
  const float length = std::min(std::hypot(vector.x, vector.y) / longest, 1.0f);
  const float hue =
      std::atan2(vector.y, vector.x) / (2 * std::numbers::pi_v<float>);  // turns, clockwise from right
  const auto channel = [&](float centre) {
    const float away = std::abs(hue - centre - std::round(hue - centre)) * 6;  // in sixths of a turn
    return static_cast<std::uint8_t>(std::lround(255 * length * std::clamp(2 - away, 0.0f, 1.0f)));
  };
  return {channel(0), channel(1.0f / 3), channel(2.0f / 3)};
}

ScalarScale scale_over(std::span<const float> values, ColourMap map, bool logarithmic, Vec2 range) {
  ScalarScale scale{.low = range.y, .high = range.x, .logarithmic = logarithmic, .map = map};
  for (const float value : values) {
    if (!(value >= range.x && value <= range.y)) continue;
    scale.low = std::min(scale.low, value);
    scale.high = std::max(scale.high, value);
  }
  if (scale.low > scale.high)
    return {.low = logarithmic ? 0.1f : 0, .high = 1, .logarithmic = logarithmic, .map = map};
  if (scale.low == scale.high) scale.high = logarithmic ? scale.low * 2 : scale.low + 1;
  return scale;
}

Canvas scalar_picture(Extent extent, std::span<const float> values, const ScalarScale& scale,
                      const std::string& title) {
  Canvas canvas = canvas_with_legend(extent, title, [&](std::size_t i) {
    return std::isfinite(values[i]) ? colour_of(scale.map, position(scale, values[i])) : kNotFinite;
  });
  const int top = canvas.extent.height - kLegendHeight;
  const int width = canvas.extent.width - 2 * kInset;
  for (int x = 0; x < width; ++x) {
    const float t = static_cast<float>(x) / static_cast<float>(width - 1);
    canvas.fill(kInset + x, top + kBarTop, {1, kScaleHeight}, colour_of(scale.map, t));
  }
  constexpr int kTicks = 5;
  for (int i = 0; i < kTicks; ++i) {
    const float t = static_cast<float>(i) / (kTicks - 1);
    const std::string label = fmt::format("{:.3g}", value_at(scale, t));
    const int label_width = text_width(label, kTextSize, Face::kSans);
    const int x = kInset + static_cast<int>(t * static_cast<float>(width - label_width));
    draw_text(canvas, x, top + kTickBaseline, label, kTextSize, Face::kSans, kDimText);
  }
  return canvas;
}

Canvas vector_picture(Extent extent, std::span<const Vec2> vectors, float longest, const std::string& title,
                      const std::string& unit) {
  Canvas canvas = canvas_with_legend(extent, title, [&](std::size_t i) {
    return is_finite(vectors[i]) ? colour_of(vectors[i], longest) : kNotFinite;
  });
  const int top = canvas.extent.height - kLegendHeight;
  const int left = canvas.extent.width - kInset - kWheelSize;
  constexpr float kRadius = kWheelSize / 2.0f;
  for (int y = 0; y < kWheelSize; ++y) {
    for (int x = 0; x < kWheelSize; ++x) {
      const Vec2 vector = {static_cast<float>(x) + 0.5f - kRadius, static_cast<float>(y) + 0.5f - kRadius};
      if (std::hypot(vector.x, vector.y) > kRadius) continue;
      canvas.fill(left + x, top + (kLegendHeight - kWheelSize) / 2 + y, {1, 1}, colour_of(vector, kRadius));
    }
  }
  draw_text(canvas, kInset, top + kTitleBaseline + 24,
            fmt::format("hue: direction; rim of the wheel: {:.3g} {} and more", longest, unit), kTextSize,
            Face::kSans, kDimText);
  return canvas;
}

Canvas class_picture(Extent extent, std::span<const int> classes, std::span<const ClassColour> palette,
                     const std::string& title) {
  Canvas canvas = canvas_with_legend(extent, title, [&](std::size_t i) {
    const bool known = classes[i] >= 0 && static_cast<std::size_t>(classes[i]) < palette.size();
    return known ? palette[static_cast<std::size_t>(classes[i])].colour : kNotFinite;
  });
  const int top = canvas.extent.height - kLegendHeight;
  int x = kInset;
  for (const ClassColour& entry : palette) {
    canvas.fill(x, top + kBarTop + 4, {kScaleHeight, kScaleHeight}, entry.colour);
    x += kScaleHeight + 6;
    draw_text(canvas, x, top + kBarTop + 15, entry.name, kTextSize, Face::kSans, kDimText);
    x += text_width(entry.name, kTextSize, Face::kSans) + 2 * kInset;
  }
  return canvas;
}

}  // namespace quincunx::tools
