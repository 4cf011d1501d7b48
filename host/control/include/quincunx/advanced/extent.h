// SPDX-License-Identifier: MIT
// Extent, Vec2, Rectangle: sizes and positions. No OpenCL here, so that whoever only chooses resolutions needs none.
#pragma once

#include <cstdint>

namespace quincunx {

inline constexpr int kLargestSide = 32768;  // pixels, of a viewport or an output

// Width and height in pixels.
struct Extent {
  int width = 0;
  int height = 0;

  friend bool operator==(const Extent&, const Extent&) = default;
  std::int64_t area() const { return static_cast<std::int64_t>(width) * height; }
};

struct Vec2 {
  float x = 0;
  float y = 0;

  friend bool operator==(const Vec2&, const Vec2&) = default;
};

// Whole pixels of a picture: x to x + width - 1, y to y + height - 1.
struct Rectangle {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  friend bool operator==(const Rectangle&, const Rectangle&) = default;
};

}  // namespace quincunx
