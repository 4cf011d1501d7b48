// SPDX-License-Identifier: MIT
// TextPainter: anti-aliased text on an 8-bit picture (FreeType).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "quincunx/advanced/extent.h"

namespace quincunx::tools {

struct Rgb {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
};

constexpr Rgb kCanvasBackground{24, 24, 26};
constexpr Rgb kBrightText{236, 236, 238};
constexpr Rgb kDimText{150, 150, 156};

// An opaque RGB picture, sRGB encoded, top row first.
struct Canvas {
  Canvas(Extent size, Rgb background);

  void fill(int x, int y, Extent size, Rgb colour);  // clipped to the canvas

  Extent extent;
  std::vector<std::uint8_t> rgb;
};

enum class Face { kSans, kSansBold };
enum class Align { kLeft, kRight };

const char* font_path(Face face);  // the file of Debian's fonts-dejavu-core, whether it is there or not

// Not thread-safe. `size_px` is the height of the em; text is UTF-8, one line.
class TextPainter {
 public:
  TextPainter();  // looks for DejaVu Sans where Debian puts it
  ~TextPainter();
  TextPainter(const TextPainter&) = delete;
  TextPainter& operator=(const TextPainter&) = delete;

  bool available() const;
  int width(const std::string& text, int size_px, Face face) const;  // px; 0 where not available

  // Draws with the baseline at y; x is the left or right end. Nothing where not available.
  void draw(Canvas& canvas, int x, int y, const std::string& text, int size_px, Face face, Rgb colour,
            Align align = Align::kLeft) const;

 private:
  struct Fonts;
  std::unique_ptr<Fonts> fonts_;
};

}  // namespace quincunx::tools
