// SPDX-License-Identifier: MIT
// Pictures for people: a canvas with text, and false colour, which shows data that no eye sees (depth, velocity,
// classes, errors) with a legend under it. By OpenImageIO; thread-safe.
#pragma once

#include <cstdint>
#include <span>
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
bool has_fonts();

// Text is UTF-8, one line; `size_px` is the height of the em.
int text_width(const std::string& text, int size_px, Face face);  // px; 0 without fonts

// Draws with the baseline at y; x is the left or right end. Does nothing without fonts.
void draw_text(Canvas& canvas, int x, int y, const std::string& text, int size_px, Face face, Rgb colour,
               Align align = Align::kLeft);

// OpenImageIO's perceptually even ramps from dark to bright (van der Walt and Smith, 2015).
enum class ColourMap { kGrey, kViridis, kMagma };

constexpr Rgb kNotFinite{255, 0, 255};  // NaN and infinities in every picture below

Rgb colour_of(ColourMap map, float t);  // t is clamped to [0, 1]

// The colour of a vector: its direction is the hue (right red, down yellow-green, left cyan, up violet), its
// length the brightness, full at `longest`.
Rgb colour_of(Vec2 vector, float longest);

struct ScalarScale {
  float low = 0;  // the value at the dark end; above 0 where `logarithmic`
  float high = 1;
  bool logarithmic = false;
  ColourMap map = ColourMap::kViridis;
};

// The smallest and the largest finite value in `range`, which values outside of it do not widen: a scale over
// what is there. {0, 1} where there is none; never empty.
ScalarScale scale_over(std::span<const float> values, ColourMap map, bool logarithmic, Vec2 range);

// All pictures: `extent` values, row by row, magnified by a whole factor where they are too narrow for the
// legend.
Canvas scalar_picture(Extent extent, std::span<const float> values, const ScalarScale& scale,
                      const std::string& title);

// `longest`: length at full brightness, in the vectors' own unit; `unit`: "px a frame".
Canvas vector_picture(Extent extent, std::span<const Vec2> vectors, float longest, const std::string& title,
                      const std::string& unit);

struct ClassColour {
  std::string name;
  Rgb colour;
};

// `classes[i]` is an index into `palette`; one beyond it counts as not finite.
Canvas class_picture(Extent extent, std::span<const int> classes, std::span<const ClassColour> palette,
                     const std::string& title);

}  // namespace quincunx::tools
