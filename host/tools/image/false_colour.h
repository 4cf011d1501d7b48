// SPDX-License-Identifier: MIT
// False colour: data that no eye sees (depth, velocity, classes, errors) as a picture that a person can read,
// with a legend under it. Pure but for the fonts that it looks up; thread-safe.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "quincunx/advanced/extent.h"
#include "tools/image/text_painter.h"

namespace quincunx::tools {

// Perceptually even ramps from dark to bright (van der Walt and Smith, 2015); kMagma is also what FLIP maps
// use.
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
