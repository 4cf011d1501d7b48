// SPDX-License-Identifier: MIT
// SceneLayout: what follows from a scene once and for all: where things can be, which lights reach them,
// which shader they need, what casts shadows where. No GL.
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "frame_block.h"
#include "scene.h"

namespace quincunx::scenes {

inline constexpr int kShadowTexels = 2048;  // side of the shadow map

// Which variant of the surface shader draws something.
struct SurfaceFeatures {
  bool textured = false;
  bool base_texture = false;
  bool surface_texture = false;
  bool emissive_texture = false;
  bool normal_texture = false;
  bool vertex_colour = false;
  bool unlit = false;
  bool mask = false;
  bool blend = false;
  bool double_sided = false;
  bool shadows = false;
  int point_lights = 0;  // fixed count of the loop: 0, 2, 4, 8 or 16

  auto operator<=>(const SurfaceFeatures&) const = default;
  std::vector<std::string> defines() const;
};

struct MeshRange {
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
  std::int32_t base_vertex = 0;
  Bounds box;  // mesh space
  int material = 0;
};

struct PlacedInstance {
  int mesh = 0;
  bool moves = false;
  bool mirrored = false;  // negative determinant: the winding is reversed
  bool casts_shadow = false;
  glm::mat4 transform{1};  // where it stands, if it does not move
  Bounds reach;            // world bounds; of a moving one over the whole duration
  int program = 0;         // index into SceneLayout::programs
  int light_set = -1;      // index into SceneLayout::light_sets; -1: none
};

// The sun's orthographic view around all that casts shadows, fixed for the scene so that shadows never crawl.
struct ShadowFit {
  bool enabled = false;
  bool moves = false;              // some caster moves
  glm::mat4 shadow_from_world{1};  // to (u, v, depth), each within [0, 1] for casters
  float texel_metres = 0;          // world size of a texel, the larger side
};

struct SceneLayout {
  std::vector<MeshRange> meshes;
  std::vector<PlacedInstance> instances;
  std::vector<SurfaceFeatures> programs;
  std::vector<LightsBlock> light_sets;
  ShadowFit shadow;
};

// `scene` has passed check_scene().
SceneLayout lay_out(const Scene& scene);

}  // namespace quincunx::scenes
