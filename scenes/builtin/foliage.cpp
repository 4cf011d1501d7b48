// SPDX-License-Identifier: MIT
#include "builtin/foliage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace quincunx::scenes {

namespace {

constexpr float kTau = glm::two_pi<float>();

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

}  // namespace

Material leaf_material(int leaf_texture) {
  Material material = plain_material("leaves", glm::vec3(1), 0.75f);
  material.base_colour_texture.texture = leaf_texture;
  material.alpha_mode = AlphaMode::kMask;
  material.alpha_cutoff = 0.4f;
  return material;
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
    assembly.move(assembly.add(leaves.take()), sway);
    if (!fruits.empty()) assembly.move(assembly.add(fruits.take()), sway);
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

}  // namespace quincunx::scenes
