// SPDX-License-Identifier: MIT
// The courtyard's parts. x to the right, -z away from the camera, the paving at y = 0; the fountain stands in
// the middle of four orange trees: a quincunx.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "builtin/scene_assembly.h"

namespace quincunx::scenes {

struct PlantMaterials {
  int leaves = 0;  // masked, leaf_texture()
  int bark = 0;
  int fruit = 0;
};

Material leaf_material(int leaf_texture);

inline constexpr double kCourtyardDuration = 8;
inline constexpr glm::vec3 kFountain{0, 0, -0.6f};
inline constexpr float kPorticoFloor = 0.64f;

// Parts of the scene that are collected apart (SceneAssembly::still), so that few lamps reach each.
enum CourtyardPart {
  kArcade,
  kFacade,
  kTower,
  kRightWall,
  kFountainPart,
  kGarden,
  kProps,
  kTrees,
  kPots = kTrees + 4
};

struct CourtyardMaterials {
  int brick, ashlar, plaster, paving, planks, limestone, tiles;
  int iron, gilt, bronze, shutters, window, terracotta, soil;
  int water, glass, lamp, ember, poster_title, poster_figures;
  PlantMaterials plants;
};

void add_courtyard_ground(SceneAssembly& assembly, const CourtyardMaterials& materials);
void add_courtyard_arcade(SceneAssembly& assembly, const CourtyardMaterials& materials);
void add_courtyard_facade(SceneAssembly& assembly, const CourtyardMaterials& materials);
void add_courtyard_tower(SceneAssembly& assembly, const CourtyardMaterials& materials);
void add_courtyard_garden(SceneAssembly& assembly, const CourtyardMaterials& materials, std::uint64_t seed);
void add_courtyard_props(SceneAssembly& assembly, const CourtyardMaterials& materials);
// Lanterns, pennants, cart, wind wheel, swifts; and the particles.
void add_courtyard_motion(SceneAssembly& assembly, const CourtyardMaterials& materials, std::uint64_t seed);
void add_courtyard_particles(Scene& scene, std::uint64_t seed);

}  // namespace quincunx::scenes
