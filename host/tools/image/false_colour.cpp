// SPDX-License-Identifier: MIT
#include "tools/image/false_colour.h"

#include <algorithm>
#include <array>
#include <cmath>
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

using Stops = std::array<Rgb, 9>;
constexpr Stops kGreyStops = {{{0, 0, 0},
                               {32, 32, 32},
                               {64, 64, 64},
                               {96, 96, 96},
                               {128, 128, 128},
                               {159, 159, 159},
                               {191, 191, 191},
                               {223, 223, 223},
                               {255, 255, 255}}};
constexpr Stops kViridisStops = {{{68, 1, 84},
                                  {71, 44, 122},
                                  {59, 81, 139},
                                  {44, 113, 142},
                                  {33, 144, 141},
                                  {39, 173, 129},
                                  {92, 200, 99},
                                  {170, 220, 50},
                                  {253, 231, 37}}};
constexpr Stops kMagmaStops = {{{0, 0, 4},
                                {28, 16, 68},
                                {79, 18, 123},
                                {129, 37, 129},
                                {181, 54, 122},
                                {229, 80, 100},
                                {251, 135, 97},
                                {254, 194, 135},
                                {252, 253, 191}}};

std::uint8_t mixed(std::uint8_t a, std::uint8_t b, float t) {
  return static_cast<std::uint8_t>(
      std::lround(static_cast<float>(a) + (static_cast<float>(b) - static_cast<float>(a)) * t));
}

Rgb mixed(Rgb a, Rgb b, float t) {
  return {mixed(a.r, b.r, t), mixed(a.g, b.g, t), mixed(a.b, b.b, t)};
}

const Stops& stops_of(ColourMap map) {
  switch (map) {
    case ColourMap::kGrey:
      return kGreyStops;
    case ColourMap::kViridis:
      return kViridisStops;
    case ColourMap::kMagma:
      return kMagmaStops;
  }
  return kGreyStops;
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
  TextPainter().draw(canvas, kInset, shown.height + kTitleBaseline, title, kTextSize, Face::kSansBold,
                     kBrightText);
  return canvas;
}

bool is_finite(Vec2 vector) {
  return std::isfinite(vector.x) && std::isfinite(vector.y);
}

}  // namespace

Rgb colour_of(ColourMap map, float t) {
  const Stops& stops = stops_of(map);
  const float place = std::clamp(t, 0.0f, 1.0f) * static_cast<float>(stops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  return mixed(stops[below], stops[below + 1], place - static_cast<float>(below));
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
  const TextPainter painter;
  constexpr int kTicks = 5;
  for (int i = 0; i < kTicks; ++i) {
    const float t = static_cast<float>(i) / (kTicks - 1);
    const std::string label = fmt::format("{:.3g}", value_at(scale, t));
    const int label_width = painter.width(label, kTextSize, Face::kSans);
    const int x = kInset + static_cast<int>(t * static_cast<float>(width - label_width));
    painter.draw(canvas, x, top + kTickBaseline, label, kTextSize, Face::kSans, kDimText);
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
  TextPainter().draw(canvas, kInset, top + kTitleBaseline + 24,
                     fmt::format("hue: direction; rim of the wheel: {:.3g} {} and more", longest, unit),
                     kTextSize, Face::kSans, kDimText);
  return canvas;
}

Canvas class_picture(Extent extent, std::span<const int> classes, std::span<const ClassColour> palette,
                     const std::string& title) {
  Canvas canvas = canvas_with_legend(extent, title, [&](std::size_t i) {
    const bool known = classes[i] >= 0 && static_cast<std::size_t>(classes[i]) < palette.size();
    return known ? palette[static_cast<std::size_t>(classes[i])].colour : kNotFinite;
  });
  const TextPainter painter;
  const int top = canvas.extent.height - kLegendHeight;
  int x = kInset;
  for (const ClassColour& entry : palette) {
    canvas.fill(x, top + kBarTop + 4, {kScaleHeight, kScaleHeight}, entry.colour);
    x += kScaleHeight + 6;
    painter.draw(canvas, x, top + kBarTop + 15, entry.name, kTextSize, Face::kSans, kDimText);
    x += painter.width(entry.name, kTextSize, Face::kSans) + 2 * kInset;
  }
  return canvas;
}

}  // namespace quincunx::tools
