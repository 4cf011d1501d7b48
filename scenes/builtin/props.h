// SPDX-License-Identifier: MIT
// Props that several procedural scenes share.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "builtin/scene_assembly.h"

namespace quincunx::scenes {

// Lettering on a sheet: a title, a motif of five pips, lines of text, small print.
struct Poster {
  int width = 768;  // pixels
  int height = 1024;
  glm::vec3 paper{0.93f, 0.89f, 0.80f};  // as displayed
  glm::vec3 ink{0.13f, 0.12f, 0.14f};
  glm::vec3 accent{0.70f, 0.16f, 0.12f};
  std::string title;
  std::vector<std::string> lines;
  std::vector<std::string> small_print;
  std::uint64_t seed = 0;
};
Texture poster_texture(const Poster& poster);
Poster quincunx_poster(std::uint64_t seed);  // what the name means, and the alphabet
Poster die_poster(std::uint64_t seed);
Poster figures_poster(std::uint64_t seed);

// A material that shows a texture, matt.
int add_picture_material(SceneAssembly& assembly, const std::string& name, Texture texture);

// A brick wall that faces +z, its foot at y = 0, with a stone base and posters; `width` around x = 0.
void add_poster_wall(SceneAssembly& assembly, float width, float height, float z, std::uint64_t seed);

// Paving at y = 0 in front of such a wall: `width` around x = 0, from z = `front` to `depth` behind it.
void add_paving(SceneAssembly& assembly, float width, float front, float depth, std::uint64_t seed);

// A sunny day for scenes without a mood of their own.
void set_daylight(Scene& scene);

}  // namespace quincunx::scenes
