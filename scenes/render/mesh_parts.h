// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

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

}  // namespace quincunx::scenes
