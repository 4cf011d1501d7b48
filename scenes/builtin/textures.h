// SPDX-License-Identifier: MIT
// Textures made by rule: masonry, wood, foliage, water; and lettering, with a canvas for signs.
//
// Row 0 is the top of the picture (v = 0). Colours are given as displayed (sRGB encoded, 0 to 1). All
// surfaces repeat without a seam. Pure functions of their arguments.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string_view>
#include <vector>

#include "scene.h"

namespace quincunx::scenes {

// Smooth value noise in octaves, in [0, 1], repeating after [0, 1) each way: the first octave has `cells`
// cells, each further one twice as many at 0.55 of the weight.
class FractalNoise {
 public:
  FractalNoise(glm::ivec2 cells, int octaves, std::uint64_t seed);
  FractalNoise(int cells, int octaves, std::uint64_t seed) : FractalNoise(glm::ivec2(cells), octaves, seed) {}

  float operator()(glm::vec2 at) const;

 private:
  struct Octave {
    glm::ivec2 cells;
    float weight;
    std::vector<float> values;
  };
  std::vector<Octave> octaves_;
};

// One square repeat of a surface.
struct Surface {
  int size = 0;
  std::vector<glm::vec3> colour;
  std::vector<float> height;     // in texels
  std::vector<float> roughness;  // [0, 1]
};

Surface brick_surface(int size, std::uint64_t seed);   // a repeat is 1.92 m: 8 by 24 bricks in stretcher bond
Surface ashlar_surface(int size, std::uint64_t seed);  // 2.4 m: six courses of dressed stone
Surface plaster_surface(int size, std::uint64_t seed);  // 4 m: weathered limewash
Surface paving_surface(int size, std::uint64_t seed);   // 2.4 m: flags with inlaid diamonds, fives of a die
Surface plank_surface(int size, std::uint64_t seed);    // 1 m: six upright boards
Surface stone_surface(int size, std::uint64_t seed);    // 1 m: plain, finely worked
Surface grass_surface(int size, std::uint64_t seed);    // 3 m: a mown meadow

Texture colour_texture(const Surface& surface);
Texture normal_texture(const Surface& surface, float strength = 1);  // glTF: green points up, against v
Texture roughness_texture(const Surface& surface);                   // G roughness, B metallic 0

Texture leaf_texture(int size, std::uint64_t seed);  // a sprig of leaves with alpha, stem at the bottom
Texture water_normal_texture(int size, std::uint64_t seed);  // ripples round the centre
Texture cloud_texture(int width, int height,
                      std::uint64_t seed);  // streaks with alpha; repeats in u, ends softly in v

// A stroke font of our own, as polylines: the same strokes become geometry or texels, sharp at any size. It has
// printable ASCII; other characters are drawn as an open box. Lengths are in cap heights: a capital stands from y = 0
// to y = 1, y up; descenders reach to -1/3.
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

// A picture to draw on, in pixels, y down; shapes are antialiased.
class Canvas {
 public:
  Canvas(int width, int height, glm::vec4 background);

  void rectangle(glm::vec2 low, glm::vec2 high, glm::vec4 colour);
  void disc(glm::vec2 centre, float radius, glm::vec4 colour);
  void stroke(const Polyline& path, float width, glm::vec4 colour);
  // `baseline`: the point that style.align speaks of; the stroke is `weight` of the cap height.
  void text(std::string_view text, glm::vec2 baseline, const TextStyle& style, float weight,
            glm::vec4 colour);
  // Multiplies every pixel by a function of its place in [0, 1] x [0, 1].
  void shade(const std::function<float(glm::vec2)>& factor);

  Texture texture() const;  // clamped, sRGB

 private:
  void cover(int x, int y, float coverage, glm::vec4 colour);

  int width_;
  int height_;
  std::vector<glm::vec4> pixels_;
};

}  // namespace quincunx::scenes
