// SPDX-License-Identifier: MIT
// A stroke font of our own, and the canvas that signs are lettered on.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/gtc/constants.hpp>

#include "builtin/textures.h"

namespace quincunx::scenes {
namespace {

// Units: a capital is six high, x grows to the right. "x,y" a point; ";" lifts the pen;
// "@cx,cy,rx,ry,from,to" an arc of an ellipse in degrees.
struct GlyphPath {
  char character;
  const char* path;
};

constexpr std::array kGlyphs = std::to_array<GlyphPath>({
    {'A', "0,0 2.2,6 4.4,0;.73,2 3.67,2"},
    {'B', "0,0 0,6 2.4,6 @2.4,4.6,1.4,1.4,90,-90 0,3.2;2.4,3.2 @2.4,1.6,1.6,1.6,90,-90 0,0"},
    {'C', "@2.3,3,2.3,3,48,312"},
    {'D', "0,0 0,6 1.4,6 @1.4,3,2.8,3,90,-90 0,0"},
    {'E', "3.6,0 0,0 0,6 3.6,6;0,3.1 3,3.1"},
    {'F', "0,0 0,6 3.6,6;0,3.1 3,3.1"},
    {'G', "@2.3,3,2.3,3,48,335 4.4,2.8 2.6,2.8"},
    {'H', "0,0 0,6;4,0 4,6;0,3.1 4,3.1"},
    {'I', "0,0 0,6"},
    {'J', "2.8,6 2.8,1.5 @1.3,1.5,1.5,1.5,0,-150"},
    {'K', "0,0 0,6;4,6 0,2.3;1.4,3.6 4.1,0"},
    {'L', "0,6 0,0 3.4,0"},
    {'M', "0,0 0,6 2.4,1.6 4.8,6 4.8,0"},
    {'N', "0,0 0,6 4,0 4,6"},
    {'O', "@2.4,3,2.4,3,90,450"},
    {'P', "0,0 0,6 2.4,6 @2.4,4.35,1.65,1.65,90,-90 0,2.7"},
    {'Q', "@2.4,3,2.4,3,90,450;2.8,1.5 4.7,-.5"},
    {'R', "0,0 0,6 2.4,6 @2.4,4.35,1.65,1.65,90,-90 0,2.7;2.2,2.7 4,0"},
    {'S', "@2,4.45,1.75,1.55,35,270 @2,1.45,1.9,1.45,90,-145"},
    {'T', "2.1,0 2.1,6;0,6 4.2,6"},
    {'U', "0,6 0,2 @2,2,2,2,180,360 4,6"},
    {'V', "0,6 2.1,0 4.2,6"},
    {'W', "0,6 1.5,0 3,5 4.5,0 6,6"},
    {'X', "0,0 4,6;0,6 4,0"},
    {'Y', "0,6 2.1,3 4.2,6;2.1,3 2.1,0"},
    {'Z', "0,6 4,6 0,0 4,0"},
    {'a', "@1.6,2,1.6,2,0,360;3.2,4 3.2,0"},
    {'b', "0,6 0,0;@1.6,2,1.6,2,180,540"},
    {'c', "@1.7,2,1.7,2,50,310"},
    {'d', "3.2,6 3.2,0;@1.6,2,1.6,2,0,360"},
    {'e', ".05,2.1 3.3,2.1 @1.68,2,1.65,2,3,310"},
    {'f', ".9,0 .9,4.7 @2.1,4.7,1.2,1.3,180,80;0,4 2,4"},
    {'g', "3.2,4 3.2,-.5 @1.6,-.5,1.6,1.5,0,-140;@1.6,2,1.6,2,0,360"},
    {'h', "0,6 0,0;0,2.4 @1.5,2.4,1.5,1.6,180,0 3,0"},
    {'i', "0,4 0,0;0,5.6 0,5.7"},
    {'j', "1,4 1,-.7 @0,-.7,1,1.2,0,-90;1,5.6 1,5.7"},
    {'k', "0,6 0,0;2.8,4 0,1.5;1,2.4 3,0"},
    {'l', "0,6 0,0"},
    {'m', "0,4 0,0;0,2.6 @1.2,2.6,1.2,1.4,180,0 2.4,0;2.4,2.6 @3.6,2.6,1.2,1.4,180,0 4.8,0"},
    {'n', "0,4 0,0;0,2.4 @1.5,2.4,1.5,1.6,180,0 3,0"},
    {'o', "@1.7,2,1.7,2,90,450"},
    {'p', "0,4 0,-2;@1.6,2,1.6,2,180,540"},
    {'q', "3.2,4 3.2,-2;@1.6,2,1.6,2,0,360"},
    {'r', "0,4 0,0;0,2.4 @1.5,2.4,1.5,1.6,180,60"},
    {'s', "@1.4,2.98,1.2,1.02,35,270 @1.4,.98,1.35,.98,90,-145"},
    {'t', ".9,5.4 .9,1.2 @2,1.2,1.1,1.2,180,280;0,4 2,4"},
    {'u', "0,4 0,1.6 @1.5,1.6,1.5,1.6,180,360 3,4;3,4 3,0"},
    {'v', "0,4 1.5,0 3,4"},
    {'w', "0,4 1.1,0 2.2,3.6 3.3,0 4.4,4"},
    {'x', "0,0 3,4;0,4 3,0"},
    {'y', "0,4 1.6,0;3.2,4 .9,-2"},
    {'z', "0,4 3,4 0,0 3,0"},
    {'0', "@1.9,3,1.9,3,90,450"},
    {'1', "0,4.6 1.4,6 1.4,0"},
    {'2', "@1.9,4.2,1.8,1.8,160,-35 0,0 3.8,0"},
    {'3', "@1.8,4.5,1.5,1.5,150,-90;1.8,3 @1.8,1.5,1.8,1.5,90,-150"},
    {'4', "2.9,0 2.9,6 0,1.7 4,1.7"},
    {'5', "3.4,6 .5,6 .3,3.3 @1.8,1.95,1.9,1.95,128,-145"},
    {'6', "@1.9,1.9,1.85,1.9,180,540;@3.6,1.9,3.55,4.1,98,180"},
    {'7', "0,6 3.8,6 1.2,0"},
    {'8', "@1.9,4.5,1.55,1.5,-90,270;@1.9,1.5,1.85,1.5,90,450"},
    {'9', "@1.9,4.1,1.85,1.9,0,360;@.2,4.1,3.55,4.1,-82,0"},
    {'.', "0,0 .4,0 .4,.4 0,.4 0,0"},
    {',', ".5,.1 0,-1.1"},
    {':', "0,0 0,.1;0,3.4 0,3.5"},
    {';', ".5,.1 0,-1.1;.5,3.4 .5,3.5"},
    {'\'', "0,6 0,4.6"},
    {'"', "0,6 0,4.6;1.2,6 1.2,4.6"},
    {'`', "0,6 1,5"},
    {'-', "0,2.6 2.2,2.6"},
    {'_', "0,-1 4,-1"},
    {'+', "0,2.6 3,2.6;1.5,1.1 1.5,4.1"},
    {'=', "0,1.9 3,1.9;0,3.4 3,3.4"},
    {'*', "1.5,3 1.5,6;.2,3.75 2.8,5.25;.2,5.25 2.8,3.75"},
    {'/', "0,-.6 2.8,6.4"},
    {'\\', "0,6.4 2.8,-.6"},
    {'|', "0,-1.5 0,6.5"},
    {'(', "@2.6,2.5,2.6,4.4,120,240"},
    {')', "@-1.3,2.5,2.6,4.4,60,-60"},
    {'[', "1.3,6.5 0,6.5 0,-1.2 1.3,-1.2"},
    {']', "0,6.5 1.3,6.5 1.3,-1.2 0,-1.2"},
    {'{', "1.8,6.5 .9,6.1 .9,3.2 0,2.6 .9,2 .9,-.9 1.8,-1.2"},
    {'}', "0,6.5 .9,6.1 .9,3.2 1.8,2.6 .9,2 .9,-.9 0,-1.2"},
    {'<', "3,4.6 0,2.6 3,.6"},
    {'>', "0,4.6 3,2.6 0,.6"},
    {'!', "0,6 0,1.9;0,0 0,.1"},
    {'?', "@1.5,4.5,1.5,1.5,160,-60 1.5,2.6 1.5,1.8;1.5,0 1.5,.1"},
    {'#', "1,0 1.9,6;2.9,0 3.8,6;0,1.9 4.4,1.9;.4,4.1 4.8,4.1"},
    {'%', "@1.2,4.7,1.1,1.3,0,360;@4,1.3,1.1,1.3,0,360;.8,0 4.4,6"},
    {'&', "4.2,0 .9,4.2 @1.9,4.8,1.1,1.2,200,-40 @1.7,1.5,1.7,1.5,110,320 4.1,2.8"},
    {'$', "@2,4.15,1.7,1.25,35,270 @2,1.65,1.8,1.25,90,-145;2,6.5 2,-.5"},
    {'@', "@2.4,2.7,1.1,1.3,0,360;3.5,4 3.5,2 @4.1,2,.6,.7,180,360 @2.4,2.7,2.5,3.1,0,300"},
    {'^', "0,4 1.5,6 3,4"},
    {'~', "@.8,2.4,.8,.8,180,0 @2.4,2.4,.8,.8,180,360"},
});

constexpr const char* kUnknown = "0,0 3.6,0 3.6,6 0,6 0,0";
constexpr float kUnitsPerCap = 6;
constexpr float kSpaceUnits = 3.4f;
constexpr float kGapUnits = 1.7f;  // between the edges of two neighbours
constexpr float kArcStepDegrees = 15;

struct Glyph {
  std::vector<Polyline> strokes;  // left edge at x = 0, in cap heights
  float width = 0;
};

const char* path_of(char character) {
  const auto found = std::find_if(kGlyphs.begin(), kGlyphs.end(),
                                  [&](const GlyphPath& glyph) { return glyph.character == character; });
  return found == kGlyphs.end() ? kUnknown : found->path;
}

float read_number(const char*& at) {
  char* end = nullptr;
  const float value = std::strtof(at, &end);
  at = *end == ',' ? end + 1 : end;
  return value;
}

void read_arc(const char*& at, Polyline& stroke) {
  std::array<float, 6> values{};
  for (float& value : values)
    value = read_number(at);
  const auto [cx, cy, rx, ry, from, to] = values;
  const int pieces = std::max(2, static_cast<int>(std::lround(std::abs(to - from) / kArcStepDegrees)));
  for (int i = 0; i <= pieces; ++i) {
    const float angle = glm::radians(glm::mix(from, to, static_cast<float>(i) / static_cast<float>(pieces)));
    stroke.emplace_back(cx + rx * std::cos(angle), cy + ry * std::sin(angle));
  }
}

Glyph glyph_of(char character) {
  Glyph glyph;
  if (character == ' ') {
    glyph.width = (kSpaceUnits - kGapUnits) / kUnitsPerCap;
    return glyph;
  }
  glyph.strokes.emplace_back();
  for (const char* at = path_of(character); *at != '\0';) {
    if (*at == ' ') {
      ++at;
    } else if (*at == ';') {
      glyph.strokes.emplace_back();
      ++at;
    } else if (*at == '@') {
      read_arc(++at, glyph.strokes.back());
    } else {
      const float x = read_number(at);
      glyph.strokes.back().emplace_back(x, read_number(at));
    }
  }
  float low = 1e9f;
  float high = -1e9f;
  for (const Polyline& stroke : glyph.strokes) {
    for (const glm::vec2 point : stroke) {
      low = std::min(low, point.x);
      high = std::max(high, point.x);
    }
  }
  for (Polyline& stroke : glyph.strokes) {
    for (glm::vec2& point : stroke)
      point = (point - glm::vec2(low, 0)) / kUnitsPerCap;
  }
  glyph.width = (high - low) / kUnitsPerCap;
  return glyph;
}

}  // namespace

float text_width(std::string_view text, const TextStyle& style) {
  float width = 0;
  for (const char character : text)
    width += glyph_of(character).width;
  const float gaps = text.empty() ? 0 : static_cast<float>(text.size() - 1);
  return style.cap_height * (width + gaps * (kGapUnits / kUnitsPerCap + style.tracking));
}

std::vector<Polyline> text_strokes(std::string_view text, glm::vec2 anchor, const TextStyle& style) {
  const float width = style.align == Align::kLeft ? 0 : text_width(text, style);
  anchor.x -= style.align == Align::kCentre ? width / 2 : width;
  std::vector<Polyline> strokes;
  for (const char character : text) {
    Glyph glyph = glyph_of(character);
    for (Polyline& stroke : glyph.strokes) {
      for (glm::vec2& point : stroke)
        point = anchor + style.cap_height * point;
      strokes.push_back(std::move(stroke));
    }
    anchor.x += style.cap_height * (glyph.width + kGapUnits / kUnitsPerCap + style.tracking);
  }
  return strokes;
}

namespace {

float distance_to_segment(glm::vec2 point, glm::vec2 from, glm::vec2 to) {
  const glm::vec2 along = to - from;
  const float squared = glm::dot(along, along);
  const float t = squared > 0 ? std::clamp(glm::dot(point - from, along) / squared, 0.0f, 1.0f) : 0.0f;
  return glm::length(point - (from + t * along));
}

float distance_to_path(glm::vec2 point, const Polyline& path) {
  float nearest = glm::length(point - path.front());
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    nearest = std::min(nearest, distance_to_segment(point, path[k], path[k + 1]));
  }
  return nearest;
}

struct PixelRange {
  int low;
  int high;  // exclusive
};

PixelRange pixels_between(float low, float high, int size) {
  return {std::clamp(static_cast<int>(std::floor(low)), 0, size),
          std::clamp(static_cast<int>(std::ceil(high)), 0, size)};
}

// Part of the pixel [x, x + 1] that lies within [low, high].
float overlap(int x, float low, float high) {
  const float left = static_cast<float>(x);
  return std::clamp(std::min(left + 1, high) - std::max(left, low), 0.0f, 1.0f);
}

}  // namespace

Canvas::Canvas(int width, int height, glm::vec4 background)
    : width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), background) {}

void Canvas::cover(int x, int y, float coverage, glm::vec4 colour) {
  glm::vec4& pixel =
      pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
  pixel = glm::mix(pixel, colour, coverage);
}

void Canvas::rectangle(glm::vec2 low, glm::vec2 high, glm::vec4 colour) {
  const PixelRange rows = pixels_between(low.y, high.y, height_);
  const PixelRange columns = pixels_between(low.x, high.x, width_);
  for (int y = rows.low; y < rows.high; ++y) {
    for (int x = columns.low; x < columns.high; ++x) {
      cover(x, y, overlap(x, low.x, high.x) * overlap(y, low.y, high.y), colour);
    }
  }
}

void Canvas::disc(glm::vec2 centre, float radius, glm::vec4 colour) {
  stroke({centre}, 2 * radius, colour);
}

void Canvas::stroke(const Polyline& path, float width, glm::vec4 colour) {
  const float reach = width / 2 + 1;
  glm::vec2 low = path.front();
  glm::vec2 high = path.front();
  for (const glm::vec2 point : path) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  const PixelRange rows = pixels_between(low.y - reach, high.y + reach, height_);
  const PixelRange columns = pixels_between(low.x - reach, high.x + reach, width_);
  for (int y = rows.low; y < rows.high; ++y) {
    for (int x = columns.low; x < columns.high; ++x) {
      const float distance = distance_to_path(glm::vec2(x, y) + 0.5f, path);
      cover(x, y, std::clamp(width / 2 - distance + 0.5f, 0.0f, 1.0f), colour);
    }
  }
}

void Canvas::text(std::string_view text, glm::vec2 baseline, const TextStyle& style, float weight,
                  glm::vec4 colour) {
  for (Polyline& path : text_strokes(text, {0, 0}, style)) {
    for (glm::vec2& point : path)
      point = baseline + glm::vec2(point.x, -point.y);
    stroke(path, weight * style.cap_height, colour);
  }
}

void Canvas::shade(const std::function<float(glm::vec2)>& factor) {
  const glm::vec2 size(width_, height_);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const float value = factor((glm::vec2(x, y) + 0.5f) / size);
      glm::vec4& pixel = pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                 static_cast<std::size_t>(x)];
      pixel = glm::vec4(glm::vec3(pixel) * value, pixel.a);
    }
  }
}

Texture Canvas::texture() const {
  Texture texture;
  texture.width = width_;
  texture.height = height_;
  texture.wrap_u = texture.wrap_v = Wrap::kClamp;
  texture.rgba.reserve(pixels_.size() * 4);
  for (const glm::vec4& pixel : pixels_) {
    for (int i = 0; i < 4; ++i) {
      texture.rgba.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(pixel[i], 0.0f, 1.0f) * 255)));
    }
  }
  return texture;
}

}  // namespace quincunx::scenes
