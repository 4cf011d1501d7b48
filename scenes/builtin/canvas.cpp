// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "builtin/textures.h"

namespace quincunx::scenes {

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
