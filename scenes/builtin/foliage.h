// SPDX-License-Identifier: MIT
// Plants from alpha-tested cards: trees that sway, ivy, pots, and shapes for the distance.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "builtin/scene_assembly.h"
#include "random.h"

namespace quincunx::scenes {

struct PlantMaterials {
  int leaves = 0;  // masked, leaf_texture()
  int bark = 0;
  int fruit = 0;
};

Material leaf_material(int leaf_texture);

struct Tree {
  glm::vec3 foot{0};
  float trunk = 1.3f;   // metres to where the crown begins
  float crown = 0.95f;  // radius
  int leaves = 320;     // cards
  int fruits = 26;
  double period = 8;  // seconds after which its sway repeats
};
void add_tree(SceneAssembly& assembly, const PlantMaterials& materials, const Tree& tree, Random& random);

// Leaves on a wall: over the parallelogram origin + s * right + t * up, densest at the low edge, `reach` of
// the height at its sides.
struct Ivy {
  glm::vec3 origin{0};
  glm::vec3 right{1, 0, 0};
  glm::vec3 up{0, 1, 0};
  int leaves = 200;
  float size = 0.2f;  // half the width of a card
};
void add_ivy(MeshBuilder& leaves, const Ivy& ivy, Random& random);

// A low bush: a dome of cards.
void add_bush(MeshBuilder& leaves, glm::vec3 foot, float radius, float height, int count, Random& random);

// A cypress for the middle distance: a slender cone of cards.
void add_cypress(MeshBuilder& leaves, glm::vec3 foot, float height, Random& random);

}  // namespace quincunx::scenes
