// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "builtin/architecture.h"
#include "builtin/courtyard.h"
#include "random.h"

namespace quincunx::scenes {
namespace {

struct Tree {
  glm::vec3 foot{0};
  float trunk = 1.3f;   // metres to where the crown begins
  float crown = 0.95f;  // radius
  int leaves = 320;     // cards
  int fruits = 26;
  double period = 8;  // seconds after which its sway repeats
};

// Leaves on a wall: over the parallelogram origin + s * right + t * up, densest at the low edge, `reach` of
// the height at its sides.
struct Ivy {
  glm::vec3 origin{0};
  glm::vec3 right{1, 0, 0};
  glm::vec3 up{0, 1, 0};
  int leaves = 200;
  float size = 0.2f;  // half the width of a card
};

glm::vec3 random_direction(Random& random) {
  const float y = random.signed_unit();
  const float angle = random.range(0, kTau);
  const float radius = std::sqrt(std::max(0.0f, 1 - y * y));
  return {radius * std::cos(angle), y, radius * std::sin(angle)};
}

// A card that faces `outward` roughly, its tip pointing up or outwards.
void leaf_card(MeshBuilder& leaves, glm::vec3 at, glm::vec3 outward, float half, glm::vec3 normal,
               Random& random) {
  const glm::vec3 facing = glm::normalize(outward + 0.9f * random_direction(random));
  const auto [x, y] = frame_around(facing);
  const float turn = random.range(-1.1f, 1.1f);
  const glm::vec3 up = std::cos(turn) * y + std::sin(turn) * x;
  const glm::vec3 right = glm::cross(up, facing);
  leaves.card(at, right * half, up * half, normal);
}

void trunk(MeshBuilder& bark, const Tree& tree, Random& random) {
  std::vector<glm::vec3> path;
  std::vector<float> radii;
  constexpr int kPieces = 6;
  glm::vec3 at = tree.foot;
  for (int i = 0; i <= kPieces; ++i) {
    path.push_back(at);
    radii.push_back(glm::mix(0.085f, 0.05f, static_cast<float>(i) / kPieces) + (i == 0 ? 0.035f : 0.0f));
    at += glm::vec3(0.025f * random.signed_unit(), (tree.trunk + 0.3f * tree.crown) / kPieces,
                    0.025f * random.signed_unit());
  }
  bark.tube(path, radii, 9);
  const glm::vec3 fork = path[kPieces - 1];
  for (int branch = 0; branch < 7; ++branch) {
    const float angle = kTau * (static_cast<float>(branch) + 0.5f * random.unit()) / 7;
    const glm::vec3 out(std::cos(angle), random.range(0.5f, 1.1f), std::sin(angle));
    const glm::vec3 tip = fork + glm::normalize(out) * tree.crown * random.range(0.7f, 0.95f);
    const std::array<glm::vec3, 3> limb{fork, glm::mix(fork, tip, 0.5f) + glm::vec3(0, 0.06f, 0), tip};
    const std::array<float, 3> limb_radii{0.032f, 0.02f, 0.008f};
    bark.tube(limb, limb_radii, 6);
  }
}

void add_tree(SceneAssembly& assembly, const PlantMaterials& materials, const Tree& tree, Random& random) {
  trunk(assembly.still(materials.bark), tree, random);
  const glm::vec3 middle = tree.foot + glm::vec3(0, tree.trunk + 0.75f * tree.crown, 0);
  constexpr int kGroups = 3;
  for (int group = 0; group < kGroups; ++group) {
    MeshBuilder leaves(materials.leaves);
    MeshBuilder fruits(materials.fruit);
    const glm::vec3 pivot = tree.foot + glm::vec3(0, tree.trunk, 0);
    for (int i = group; i < tree.leaves; i += kGroups) {
      const glm::vec3 direction = random_direction(random);
      const float depth = 1 - 0.5f * random.unit() * random.unit();
      const float lumps = 1 + 0.13f * std::sin(5 * direction.x + 3 * direction.y) * std::cos(4 * direction.z);
      const glm::vec3 at = middle + direction * glm::vec3(1, 0.86f, 1) * tree.crown * depth * lumps;
      const float shade = glm::mix(0.42f, 1.0f, (depth - 0.5f) / 0.5f) * (0.82f + 0.18f * direction.y);
      leaves.pen.colour = glm::vec4(glm::vec3(shade * random.range(0.85f, 1.15f)), 1);
      const glm::vec3 normal =
          glm::normalize(direction + glm::vec3(0, 0.25f, 0) + 0.25f * random_direction(random));
      leaf_card(leaves, at - pivot, direction, 0.2f * tree.crown, normal, random);
    }
    for (int i = group; i < tree.fruits; i += kGroups) {
      const glm::vec3 direction = random_direction(random);
      fruits.sphere(
          middle + direction * glm::vec3(1, 0.86f, 1) * tree.crown * random.range(0.86f, 1.0f) - pivot,
          0.052f, 10);
    }
    const glm::vec3 axis =
        glm::normalize(glm::vec3(random.signed_unit(), 0.3f * random.signed_unit(), random.signed_unit()));
    const Motion sway =
        swinging(moved_to(pivot), axis, 0.022f, tree.period, 2 + group, random.range(0, kTau));
    assembly.move(leaves, sway);
    if (!fruits.empty()) assembly.move(fruits, sway);
  }
}

void add_ivy(MeshBuilder& leaves, const Ivy& ivy, Random& random) {
  const glm::vec3 normal = glm::normalize(glm::cross(ivy.right, ivy.up));
  constexpr int kRunners = 5;
  std::array<float, kRunners> tips{};
  for (float& tip : tips)
    tip = random.range(0.55f, 1.0f);
  for (int i = 0; i < ivy.leaves; ++i) {
    const int runner = random.below(kRunners);
    const float height = tips[static_cast<std::size_t>(runner)] * (1 - std::sqrt(random.unit()) * 0.98f);
    const float spread = 0.5f * (1 - 0.75f * height);
    const float s = (static_cast<float>(runner) + 0.5f) / kRunners +
                    0.12f * std::sin(9 * height + 2 * static_cast<float>(runner)) +
                    spread * 0.5f * random.signed_unit();
    const float stand = random.range(0.03f, 0.16f);
    const glm::vec3 at = ivy.origin + s * ivy.right + height * ivy.up + normal * stand;
    leaves.pen.colour = glm::vec4(glm::vec3(random.range(0.55f, 0.8f) + 1.6f * stand), 1);
    leaf_card(leaves, at, 1.4f * normal, ivy.size * random.range(0.7f, 1.15f),
              glm::normalize(normal + glm::vec3(0, 0.3f, 0) + 0.3f * random_direction(random)), random);
  }
}

// A low bush: a dome of cards.
void add_bush(MeshBuilder& leaves, glm::vec3 foot, float radius, float height, int count, Random& random) {
  for (int i = 0; i < count; ++i) {
    glm::vec3 direction = random_direction(random);
    direction.y = std::abs(direction.y);
    const float depth = 1 - 0.5f * random.unit() * random.unit();
    const glm::vec3 at = foot + direction * glm::vec3(radius, height, radius) * depth;
    leaves.pen.colour =
        glm::vec4(glm::vec3(random.range(0.85f, 1.15f) * glm::mix(0.45f, 1.0f, direction.y) * depth), 1);
    leaf_card(leaves, at, direction, 0.38f * radius, glm::normalize(direction + glm::vec3(0, 0.3f, 0)),
              random);
  }
}

// A cypress for the middle distance: a slender cone of cards.
void add_cypress(MeshBuilder& leaves, glm::vec3 foot, float height, Random& random) {
  constexpr int kCards = 220;
  for (int i = 0; i < kCards; ++i) {
    const float t = random.unit();
    const float angle = random.range(0, kTau);
    const float radius = 0.115f * height * std::pow(1 - t, 0.7f) * std::min(1.0f, 6 * t + 0.35f);
    const glm::vec3 out(std::cos(angle), 0.35f, std::sin(angle));
    leaves.pen.colour = glm::vec4(glm::vec3(random.range(0.30f, 0.60f)) * glm::vec3(0.80f, 1.0f, 0.95f), 1);
    leaf_card(leaves, foot + glm::vec3(out.x * radius, t * height, out.z * radius), out, 0.04f * height,
              glm::normalize(out), random);
  }
}

constexpr float kTreeOffset = 3.7f;  // from the centre to the four corners, on each axis

void add_fountain(SceneAssembly& assembly, const CourtyardMaterials& m) {
  MeshBuilder& stone = assembly.still(m.limestone, kFountainPart);
  const PenScope standing(stone, moved_to(kFountain));
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
void add_planter(SceneAssembly& assembly, const CourtyardMaterials& m, glm::vec3 foot, int part) {
  MeshBuilder& stone = assembly.still(m.limestone, part);
  const PenScope standing(stone, moved_to(foot));
  constexpr float kHalf = 0.62f;
  stone.box({-kHalf, 0, -kHalf}, {kHalf, 0.1f, kHalf});
  stone.box({-kHalf + 0.06f, 0.1f, -kHalf + 0.06f}, {kHalf - 0.06f, 0.46f, kHalf - 0.06f});
  for (const float side : {-1.0f, 1.0f}) {
    const float inner = kHalf - 0.14f;
    stone.box({side > 0 ? inner : -kHalf, 0.46f, -kHalf}, {side > 0 ? kHalf : -inner, 0.56f, kHalf});
    stone.box({-inner, 0.46f, side > 0 ? inner : -kHalf}, {inner, 0.56f, side > 0 ? kHalf : -inner});
  }
  MeshBuilder& soil = assembly.still(m.soil, part);
  soil.patch(foot + glm::vec3(-0.5f, 0.51f, 0.5f), {1, 0, 0}, {0, 0, -1});
}

void add_pot(SceneAssembly& assembly, const CourtyardMaterials& m, glm::vec3 foot, float size, int part,
             Random& random) {
  MeshBuilder& clay = assembly.still(m.terracotta, part);
  const PenScope standing(clay, moved_to(foot));
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
  add_bush(assembly.still(m.plants.leaves, part), foot + glm::vec3(0, 0.66f * size, 0), 0.55f * size,
           0.75f * size, 90, random);
}

// The land beyond: a meadow and ranges of hills, with the haze of their distance in their colour.
void add_country(SceneAssembly& assembly, Random& random) {
  MeshBuilder& land = assembly.still(assembly.add(unlit_material("country", glm::vec3(1))));
  struct Range {
    float distance, low, height;
    glm::vec3 foot, top;
  };
  constexpr std::array kRanges =
      std::to_array<Range>({{420, 16, 62, {0.66f, 0.53f, 0.42f}, {0.40f, 0.41f, 0.47f}},
                            {260, 6, 34, {0.50f, 0.39f, 0.26f}, {0.25f, 0.26f, 0.25f}},
                            {130, 1, 11, {0.34f, 0.27f, 0.12f}, {0.14f, 0.15f, 0.08f}},
                            {8, -9, 0, {0.16f, 0.14f, 0.05f}, {0.16f, 0.14f, 0.05f}}});
  constexpr int kPieces = 96;
  std::vector<std::uint32_t> before(kPieces + 1);
  for (const Range& range : kRanges) {
    const float a = random.range(0, kTau);
    const float b = random.range(0, kTau);
    std::vector<std::uint32_t> feet(kPieces + 1);
    for (std::uint32_t i = 0; i <= kPieces; ++i) {
      const float angle = kTau * (static_cast<float>(i) / kPieces -
                                  0.5f);  // from behind over the left to the front and right
      const glm::vec3 out(std::sin(angle), 0, -std::cos(angle));
      const float wave = 0.5f + 0.25f * std::sin(3 * angle + a) + 0.16f * std::sin(7 * angle + b) +
                         0.05f * std::sin(19 * angle + a) + 0.02f * std::sin(43 * angle + b);
      land.pen.colour = glm::vec4(range.foot, 1);
      feet[i] = land.vertex(out * range.distance - glm::vec3(0, 0.7f, 0), -out, {0, 0});
      if (range.height > 0) {
        land.pen.colour = glm::vec4(range.top, 1);
        land.vertex(out * range.distance + glm::vec3(0, range.low + range.height * wave, 0), -out, {0, 0});
        if (i > 0) {
          land.triangle(feet[i - 1], feet[i], feet[i] + 1);
          land.triangle(feet[i - 1], feet[i] + 1, feet[i - 1] + 1);
        }
      }
      if (i > 0 && range.distance < kRanges.front().distance) {  // the ground up to the range behind
        land.triangle(feet[i - 1], feet[i], before[i]);
        land.triangle(feet[i - 1], before[i], before[i - 1]);
      }
    }
    before = feet;
  }
}

}  // namespace

Material leaf_material(int leaf_texture) {
  Material material = plain_material("leaves", glm::vec3(1), 0.75f);
  material.base_colour_texture.texture = leaf_texture;
  material.alpha_mode = AlphaMode::kMask;
  material.alpha_cutoff = 0.4f;
  return material;
}

void add_courtyard_garden(SceneAssembly& assembly, const CourtyardMaterials& m, std::uint64_t seed) {
  Random random(seed, 11);
  add_fountain(assembly, m);
  int part = kTrees;
  for (const glm::vec2 corner : {glm::vec2(-1, -1), {1, -1}, {-1, 1}, {1, 1}}) {
    const glm::vec3 foot = kFountain + kTreeOffset * glm::vec3(corner.x, 0, corner.y);
    add_planter(assembly, m, foot, part++);
    Tree tree;
    tree.foot = foot + glm::vec3(0, 0.5f, 0);
    tree.trunk = random.range(0.95f, 1.15f);
    tree.crown = random.range(0.78f, 0.9f);
    tree.period = kCourtyardDuration;
    add_tree(assembly, m.plants, tree, random);
  }
  MeshBuilder& leaves = assembly.still(m.plants.leaves, kGarden);
  add_ivy(leaves, {{3.9f, 0.5f, -7.72f}, {2.6f, 0, 0}, {0, 6.6f, 0}, 480, 0.2f}, random);
  add_ivy(leaves, {{-6.42f, 4.9f, 5.0f}, {0, 0, -5.2f}, {0, -2.0f, 0}, 330, 0.16f}, random);
  add_ivy(leaves, {{6.26f, 0, 3.4f}, {0, 0, 2.4f}, {0, 2.2f, 0}, 260, 0.16f}, random);
  struct Pot {
    glm::vec3 foot;
    float size;
  };
  part = kPots;
  for (const Pot& pot : {Pot{{-5.7f, 0, 6.6f}, 0.8f},
                         {{-5.8f, 0, 1.4f}, 0.7f},
                         {{-5.8f, 0, -3.8f}, 0.75f},
                         {{4.9f, 0, 6.9f}, 0.95f},
                         {{-1.75f, kPorticoFloor, -7.55f}, 0.6f},
                         {{1.75f, kPorticoFloor, -7.55f}, 0.6f}}) {
    add_pot(assembly, m, pot.foot, pot.size, part++, random);
  }
  for (const glm::vec3 foot : {glm::vec3(9.0f, -0.5f, -3),
                               {9.6f, -0.5f, -8.5f},
                               {12.5f, -0.8f, -13},
                               {15.0f, -1, -9},
                               {10.6f, -0.5f, 1.2f},
                               {19.0f, -1, -20},
                               {23.0f, -1, -17}}) {
    add_cypress(leaves, foot, random.range(5.5f, 8.0f), random);
  }
  add_country(assembly, random);
}

void add_courtyard_props(SceneAssembly& assembly, const CourtyardMaterials& m) {
  // The notice on its easel, under glass, turned towards the camera.
  const glm::mat4 easel = moved_to({3.35f, 0, 4.75f}) * turned(-0.36f, {0, 1, 0});
  const glm::mat4 board = easel * moved_to({0, 0.62f, 0}) * turned(-0.14f, {1, 0, 0});
  MeshBuilder& wood = assembly.still(m.planks, kProps);
  constexpr float kWidth = 0.87f;
  constexpr float kHeight = 1.16f;
  const PenScope standing(wood, board);
  wood.box({-kWidth / 2 - 0.06f, -0.06f, -0.06f}, {kWidth / 2 + 0.06f, 0, 0.02f});
  wood.box({-kWidth / 2 - 0.06f, kHeight, -0.06f}, {kWidth / 2 + 0.06f, kHeight + 0.06f, 0.02f});
  for (const float side : {-1.0f, 1.0f}) {
    const float x = side > 0 ? kWidth / 2 : -kWidth / 2 - 0.06f;
    wood.box({x, 0, -0.06f}, {x + 0.06f, kHeight, 0.02f});
    wood.rod({side * 0.42f, kHeight + 0.2f, -0.09f}, {side * 0.56f, -0.64f, 0.02f}, 0.028f, 8);
  }
  wood.rod({0, kHeight + 0.1f, -0.1f}, {0, -0.55f, -0.62f}, 0.026f, 8);
  wood.box({-kWidth / 2, 0, -0.05f}, {kWidth / 2, kHeight, -0.02f});
  MeshBuilder& sheet = assembly.still(m.poster_title, kProps);
  sheet.pen.placement = board;
  sheet.picture({-kWidth / 2, 0, -0.015f}, {kWidth, 0, 0}, {0, kHeight, 0});
  MeshBuilder& glass = assembly.still(m.glass, kProps);
  glass.pen.placement = board;
  glass.picture({-kWidth / 2, 0, 0.0f}, {kWidth, 0, 0}, {0, kHeight, 0});
  // Notices on the arcade's back wall.
  for (const float z : {5.2f, -0.1f, -5.2f}) {
    MeshBuilder& poster = assembly.still(z > 0 ? m.poster_figures : m.poster_title, kArcade);
    poster.pen.placement = moved_to({-9.28f, 1.1f, z}) * turned(glm::half_pi<float>(), {0, 1, 0});
    poster.picture({-0.6f, 0, 0}, {1.2f, 0, 0}, {0, 1.6f, 0});
  }
}

}  // namespace quincunx::scenes
