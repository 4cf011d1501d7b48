// SPDX-License-Identifier: MIT
#include "render/mesh_parts.h"

#include <algorithm>
#include <numeric>

namespace quincunx::scenes {
namespace {

struct Triangles {
  std::vector<glm::vec3> centres;
  std::vector<std::uint32_t> order;
};

Triangles triangles_of(const Mesh& mesh) {
  Triangles triangles;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    glm::vec3 sum(0);
    for (std::size_t k = 0; k < 3; ++k)
      sum += mesh.vertices[mesh.indices[i + k]].position;
    triangles.centres.push_back(sum / 3.0f);
  }
  triangles.order.resize(triangles.centres.size());
  std::iota(triangles.order.begin(), triangles.order.end(), 0u);
  return triangles;
}

// Cuts [begin, end) of the order at the median along its longest axis until the limits hold.
void split(Triangles& triangles, std::size_t begin, std::size_t end, const PartLimits& limits,
           std::vector<std::uint32_t>& counts) {
  glm::vec3 low = triangles.centres[triangles.order[begin]];
  glm::vec3 high = low;
  for (std::size_t i = begin; i < end; ++i) {
    low = glm::min(low, triangles.centres[triangles.order[i]]);
    high = glm::max(high, triangles.centres[triangles.order[i]]);
  }
  const glm::vec3 size = high - low;
  const std::size_t count = end - begin;
  if (count <= limits.few || (count <= limits.many && glm::length(size) <= limits.metres)) {
    std::sort(triangles.order.begin() + static_cast<std::ptrdiff_t>(begin),
              triangles.order.begin() + static_cast<std::ptrdiff_t>(end));
    counts.push_back(static_cast<std::uint32_t>(3 * count));
    return;
  }
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t middle = begin + count / 2;
  const auto at = [&](std::size_t i) { return triangles.order.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
    const float ca = triangles.centres[a][axis], cb = triangles.centres[b][axis];
    return ca != cb ? ca < cb : a < b;
  });
  split(triangles, begin, middle, limits, counts);
  split(triangles, middle, end, limits, counts);
}

}  // namespace

MeshParts split_mesh(const Mesh& mesh, const PartLimits& limits) {
  MeshParts parts;
  if (mesh.indices.empty()) return parts;
  Triangles triangles = triangles_of(mesh);
  split(triangles, 0, triangles.order.size(), limits, parts.counts);
  for (const std::uint32_t triangle : triangles.order) {
    for (std::size_t k = 0; k < 3; ++k)
      parts.indices.push_back(mesh.indices[3 * triangle + k]);
  }
  return parts;
}

}  // namespace quincunx::scenes
