// SPDX-License-Identifier: MIT
// Glyphs: a stroke font of our own, as polylines. Sharp at any size: the same strokes become geometry or
// texels.
//
// Covers printable ASCII; characters it does not know are drawn as an open box. Lengths are in cap heights: a
// capital stands from y = 0 to y = 1, y up; descenders reach to -1/3.
#pragma once

#include <glm/glm.hpp>
#include <string_view>
#include <vector>

namespace quincunx::scenes {

using Polyline = std::vector<glm::vec2>;

enum class Align { kLeft, kCentre, kRight };

struct TextStyle {
  float cap_height = 1;
  float tracking = 0;  // further space after each character, in cap heights
  Align align = Align::kLeft;
};

// Width from the first character's left edge to the last one's right edge.
float text_width(std::string_view text, const TextStyle& style);

// The strokes of one line, `anchor` being the point of the baseline that `align` speaks of.
std::vector<Polyline> text_strokes(std::string_view text, glm::vec2 anchor, const TextStyle& style);

}  // namespace quincunx::scenes
