// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "procedural_architecture.h"
#include "procedural_courtyard.h"

namespace quincunx::scenes {

namespace {

constexpr float kTau = glm::two_pi<float>();
constexpr float kTreeOffset = 3.7f;  // of the four corners from the centre

void add_fountain(SceneAssembly& assembly, const CourtyardMaterials& m) {
  MeshBuilder& stone = assembly.still(m.limestone, kGarden);
  stone.pen.placement = moved_to(kFountain);
  const std::array<glm::vec2, 15> basin{{{1.72f, 0},
                                         {1.72f, 0.12f},
                                         {1.60f, 0.16f},
                                         {1.50f, 0.22f},
                                         {1.48f, 0.40f},
                                         {1.54f, 0.46f},
                                         {1.62f, 0.50f},
                                         {1.64f, 0.56f},
                                         {1.60f, 0.60f},
                                         {1.38f, 0.60f},
                                         {1.36f, 0.56f},
                                         {1.34f, 0.20f},
                                         {0.9f, 0.16f},
                                         {0.4f, 0.16f},
                                         {0.0f, 0.16f}}};
  stone.lathe(basin, 56);
  const std::array<glm::vec2, 20> shaft{{{0.34f, 0.16f}, {0.34f, 0.52f}, {0.26f, 0.60f}, {0.16f, 0.68f},
                                         {0.13f, 0.80f}, {0.17f, 0.95f}, {0.15f, 1.10f}, {0.22f, 1.18f},
                                         {0.55f, 1.26f}, {0.78f, 1.40f}, {0.80f, 1.46f}, {0.74f, 1.46f},
                                         {0.50f, 1.36f}, {0.14f, 1.34f}, {0.10f, 1.50f}, {0.12f, 1.66f},
                                         {0.09f, 1.74f}, {0.16f, 1.84f}, {0.11f, 1.96f}, {0.0f, 2.02f}}};
  stone.lathe(shaft, 40);
  stone.pen.placement = glm::mat4(1);
  MeshBuilder water(m.water);
  water.picture({-1.37f, 0, 1.37f}, {2.74f, 0, 0}, {0, 0, -2.74f});
  const int pool = assembly.add(water.take());
  // Ripples: the pool's surface turns slowly under its round rim, and sways a little.
  assembly.move(pool, [](double seconds) {
    return moved_to(kFountain +
                    glm::vec3(0, 0.47f + 0.004f * std::sin(phase_at(seconds, kCourtyardDuration, 3)), 0)) *
           turned(phase_at(seconds, kCourtyardDuration), {0, 1, 0});
  });
}

// A square planter of limestone with a tree in it.
void add_planter(SceneAssembly& assembly, const CourtyardMaterials& m, glm::vec3 foot) {
  MeshBuilder& stone = assembly.still(m.limestone, kGarden);
  stone.pen.placement = moved_to(foot);
  constexpr float kHalf = 0.62f;
  stone.box({-kHalf, 0, -kHalf}, {kHalf, 0.1f, kHalf});
  stone.box({-kHalf + 0.06f, 0.1f, -kHalf + 0.06f}, {kHalf - 0.06f, 0.46f, kHalf - 0.06f});
  for (const float side : {-1.0f, 1.0f}) {
    const float inner = kHalf - 0.14f;
    stone.box({side > 0 ? inner : -kHalf, 0.46f, -kHalf}, {side > 0 ? kHalf : -inner, 0.56f, kHalf});
    stone.box({-inner, 0.46f, side > 0 ? inner : -kHalf}, {inner, 0.56f, side > 0 ? kHalf : -inner});
  }
  stone.pen.placement = glm::mat4(1);
  MeshBuilder& soil = assembly.still(m.soil, kGarden);
  soil.patch(foot + glm::vec3(-0.5f, 0.51f, 0.5f), {1, 0, 0}, {0, 0, -1});
}

void add_pot(SceneAssembly& assembly, const CourtyardMaterials& m, glm::vec3 foot, float size,
             Random& random) {
  MeshBuilder& clay = assembly.still(m.terracotta, kGarden);
  clay.pen.placement = moved_to(foot);
  const std::array<glm::vec2, 9> profile{{{0.0f, 0.0f},
                                          {0.26f * size, 0.0f},
                                          {0.40f * size, 0.48f * size},
                                          {0.43f * size, 0.62f * size},
                                          {0.48f * size, 0.63f * size},
                                          {0.49f * size, 0.76f * size},
                                          {0.43f * size, 0.77f * size},
                                          {0.40f * size, 0.68f * size},
                                          {0.0f, 0.66f * size}}};
  clay.lathe(profile, 28);
  clay.pen.placement = glm::mat4(1);
  add_bush(assembly.still(m.plants.leaves, kGarden), foot + glm::vec3(0, 0.66f * size, 0), 0.55f * size,
           0.75f * size, 90, random);
}

// Ranges of hills with the haze of their distance in their colour.
void add_hills(SceneAssembly& assembly, Random& random) {
  const int haze = assembly.add(unlit_material("hills", glm::vec3(1)));
  MeshBuilder& hills = assembly.still(haze);
  struct Range {
    float distance, height, low;
    glm::vec3 foot, top;
  };
  constexpr std::array kRanges =
      std::to_array<Range>({{420, 62, 20, {0.62f, 0.50f, 0.40f}, {0.42f, 0.42f, 0.46f}},
                            {260, 34, 8, {0.46f, 0.37f, 0.26f}, {0.25f, 0.26f, 0.24f}},
                            {130, 12, 2, {0.30f, 0.24f, 0.12f}, {0.13f, 0.15f, 0.08f}}});
  for (const Range& range : kRanges) {
    constexpr int kPieces = 96;
    const float a = random.range(0, kTau);
    const float b = random.range(0, kTau);
    std::uint32_t before = 0;
    for (int i = 0; i <= kPieces; ++i) {
      const float turn =
          kTau * (static_cast<float>(i) / kPieces - 0.25f);  // from the left over the front to the right
      const float angle = 0.75f * turn + 0.25f * glm::half_pi<float>();
      const glm::vec3 out(std::sin(angle), 0, -std::cos(angle));
      const float wave = 0.5f + 0.25f * std::sin(3 * angle + a) + 0.16f * std::sin(7 * angle + b) +
                         0.05f * std::sin(19 * angle + a) + 0.02f * std::sin(43 * angle + b);
      const glm::vec3 ground = out * range.distance - glm::vec3(0, 8, 0);
      hills.pen.colour = glm::vec4(range.foot, 1);
      const std::uint32_t low = hills.vertex(ground, -out, {0, 0});
      hills.pen.colour = glm::vec4(range.top, 1);
      const std::uint32_t high =
          hills.vertex(ground + glm::vec3(0, 8 + range.low + range.height * wave, 0), -out, {0, 0});
      if (i > 0) {
        hills.triangle(before, low, high);
        hills.triangle(before, high, before + 1);
      }
      before = low;
    }
  }
}

}  // namespace

void add_courtyard_garden(SceneAssembly& assembly, const CourtyardMaterials& m, std::uint64_t seed) {
  Random random(seed, 11);
  add_fountain(assembly, m);
  for (const glm::vec2 corner : {glm::vec2(-1, -1), {1, -1}, {-1, 1}, {1, 1}}) {
    const glm::vec3 foot = kFountain + kTreeOffset * glm::vec3(corner.x, 0, corner.y);
    add_planter(assembly, m, foot);
    Tree tree;
    tree.foot = foot + glm::vec3(0, 0.5f, 0);
    tree.trunk = random.range(1.15f, 1.35f);
    tree.crown = random.range(0.88f, 1.0f);
    tree.period = kCourtyardDuration;
    add_tree(assembly, m.plants, tree, random);
  }
  MeshBuilder& leaves = assembly.still(m.plants.leaves, kGarden);
  add_ivy(leaves, {{3.9f, 0.5f, -7.72f}, {2.6f, 0, 0}, {0, 6.6f, 0}, 620, 0.19f}, random);
  add_ivy(leaves, {{-6.42f, 4.9f, 5.0f}, {0, 0, -5.2f}, {0, -2.0f, 0}, 330, 0.16f}, random);
  add_ivy(leaves, {{6.26f, 0, 3.4f}, {0, 0, 2.4f}, {0, 2.2f, 0}, 260, 0.16f}, random);
  add_pot(assembly, m, {-5.7f, 0, 6.6f}, 0.8f, random);
  add_pot(assembly, m, {-5.8f, 0, 1.4f}, 0.7f, random);
  add_pot(assembly, m, {-5.8f, 0, -3.8f}, 0.75f, random);
  add_pot(assembly, m, {4.9f, 0, 6.9f}, 0.95f, random);
  add_pot(assembly, m, {-1.75f, 0.64f, -7.55f}, 0.6f, random);
  add_pot(assembly, m, {1.75f, 0.64f, -7.55f}, 0.6f, random);
  for (const glm::vec3 foot : {glm::vec3(9.0f, -0.5f, -3),
                               {9.6f, -0.5f, -8.5f},
                               {12.5f, -0.8f, -13},
                               {15.0f, -1, -9},
                               {10.6f, -0.5f, 1.2f},
                               {19.0f, -1, -20},
                               {23.0f, -1, -17}}) {
    add_cypress(leaves, foot, random.range(5.5f, 8.0f), random);
  }
  MeshBuilder& meadow = assembly.still(assembly.add(plain_material("meadow", {0.15f, 0.15f, 0.055f}, 1)));
  meadow.patch({6.7f, -0.6f, 60}, {200, 0, 0}, {0, 0, -260});
  add_hills(assembly, random);
}

void add_courtyard_props(SceneAssembly& assembly, const CourtyardMaterials& m) {
  // The notice on its easel, under glass, turned towards the camera.
  const glm::mat4 easel = moved_to({3.25f, 0, 5.0f}) * turned(-0.42f, {0, 1, 0});
  const glm::mat4 board = easel * moved_to({0, 0.62f, 0}) * turned(-0.14f, {1, 0, 0});
  MeshBuilder& wood = assembly.still(m.planks, kGarden);
  constexpr float kWidth = 0.96f;
  constexpr float kHeight = 1.28f;
  wood.pen.placement = board;
  wood.box({-kWidth / 2 - 0.06f, -0.06f, -0.06f}, {kWidth / 2 + 0.06f, 0, 0.05f});
  wood.box({-kWidth / 2 - 0.06f, kHeight, -0.06f}, {kWidth / 2 + 0.06f, kHeight + 0.06f, 0.05f});
  for (const float side : {-1.0f, 1.0f}) {
    const float x = side > 0 ? kWidth / 2 : -kWidth / 2 - 0.06f;
    wood.box({x, 0, -0.06f}, {x + 0.06f, kHeight, 0.05f});
    wood.rod({side * 0.42f, kHeight + 0.2f, -0.09f}, {side * 0.56f, -0.64f, 0.02f}, 0.028f, 8);
  }
  wood.rod({0, kHeight + 0.1f, -0.1f}, {0, -0.55f, -0.62f}, 0.026f, 8);
  wood.box({-kWidth / 2, 0, -0.05f}, {kWidth / 2, kHeight, -0.02f});
  wood.pen.placement = glm::mat4(1);
  MeshBuilder& sheet = assembly.still(m.poster_title, kGarden);
  sheet.pen.placement = board;
  sheet.picture({-kWidth / 2, 0, -0.015f}, {kWidth, 0, 0}, {0, kHeight, 0});
  MeshBuilder& glass = assembly.still(m.glass, kGarden);
  glass.pen.placement = board;
  glass.picture({-kWidth / 2, 0, 0.02f}, {kWidth, 0, 0}, {0, kHeight, 0});
  // Notices on the arcade's back wall.
  for (const float z : {5.2f, -0.1f, -5.2f}) {
    MeshBuilder& poster = assembly.still(z > 0 ? m.poster_figures : m.poster_title, kArcade);
    poster.pen.placement = moved_to({-9.28f, 1.1f, z}) * turned(glm::half_pi<float>(), {0, 1, 0});
    poster.picture({-0.6f, 0, 0}, {1.2f, 0, 0}, {0, 1.6f, 0});
  }
}

}  // namespace quincunx::scenes
