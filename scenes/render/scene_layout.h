// SPDX-License-Identifier: MIT
// SceneLayout: what follows from a scene once and for all: where things can be, which lights reach them,
// which shader they need, what casts shadows where. No GL.
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "render/frame_block.h"
#include "render/view_math.h"
#include "scene.h"

namespace quincunx::scenes {

// When a part of a mesh is cut further: if it has more than `many` triangles, or more than `few` and is longer
// than `metres`.
struct PartLimits {
  std::size_t few = 96;
  std::size_t many = 2048;
  float metres = 1e30f;  // diagonal
};

// The triangles of a mesh in an order in which each part is one range.
struct MeshParts {
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> counts;  // indices of each part, in order
};

// Cuts a mesh in space, for culling and for lights that reach only some of it. Deterministic; keeps the order
// of triangles within a part. An empty mesh has no parts.
MeshParts split_mesh(const Mesh& mesh, const PartLimits& limits);

// The variant of the surface shader that draws something.
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

// A range of the index buffer: a mesh, or a part of one.
struct MeshRange {
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
  Bounds box;  // mesh space
  int material = 0;
};

struct PlacedInstance {
  int mesh = 0;  // index into SceneLayout::meshes
  bool moves = false;
  bool casts_shadow = false;
  glm::mat4 transform{1};  // where it stands, if it does not move; else where it is at time 0
  Bounds reach;            // world bounds; of a moving one over the whole duration
};

// An instance of a part: the unit that is culled, sorted and drawn.
struct Piece {
  int instance = 0;
  int part = 0;        // index into SceneLayout::parts
  Bounds box;          // world bounds, if the instance does not move
  int program = 0;     // index into SceneLayout::programs
  int light_set = -1;  // index into SceneLayout::light_sets; -1: none
};

struct SceneLayout {
  std::vector<std::uint32_t> indices;  // indices of all meshes, the triangles of a part together
  std::vector<MeshRange> meshes;
  std::vector<MeshRange> parts;
  std::vector<PlacedInstance> instances;
  std::vector<Piece> pieces;
  std::vector<SurfaceFeatures> programs;
  std::vector<LightsBlock> light_sets;
  ShadowFit shadow;
};

// `scene` has passed check_scene().
SceneLayout lay_out(const Scene& scene);

}  // namespace quincunx::scenes
