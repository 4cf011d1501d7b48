// SPDX-License-Identifier: MIT
#include "builtin/ambient_occlusion.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "builtin/mesh_builder.h"

namespace quincunx::scenes {

namespace {

// One byte per cube: whether a surface crosses it.
class CubeGrid {
 public:
  CubeGrid(const Bounds& bounds, float cell) : low_(bounds.low - cell), cell_(cell) {
    size_ = glm::ivec3(glm::ceil((bounds.high - bounds.low) / cell)) + 3;
    filled_.assign(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                       static_cast<std::size_t>(size_.z),
                   0);
  }

  void fill(glm::vec3 point) {
    const std::ptrdiff_t at = index_of(point);
    if (at >= 0) filled_[static_cast<std::size_t>(at)] = 1;
  }
  bool is_filled(glm::vec3 point) const {
    const std::ptrdiff_t at = index_of(point);
    return at >= 0 && filled_[static_cast<std::size_t>(at)] != 0;
  }

 private:
  std::ptrdiff_t index_of(glm::vec3 point) const {
    const glm::ivec3 at(glm::floor((point - low_) / cell_));
    if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, size_))) return -1;
    return (static_cast<std::ptrdiff_t>(at.z) * size_.y + at.y) * size_.x + at.x;
  }

  glm::vec3 low_;
  float cell_;
  glm::ivec3 size_{0};
  std::vector<unsigned char> filled_;
};

void fill_triangle(CubeGrid& grid, glm::vec3 a, glm::vec3 b, glm::vec3 c, float cell) {
  const float longest = std::max({glm::length(b - a), glm::length(c - a), glm::length(c - b)});
  const int steps = static_cast<int>(std::ceil(longest / (cell * 0.5f)));
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const float u = steps > 0 ? static_cast<float>(i) / static_cast<float>(steps) : 0;
      const float v = steps > 0 ? static_cast<float>(j) / static_cast<float>(steps) : 0;
      grid.fill(a + u * (b - a) + v * (c - a));
    }
  }
}

// Cosine-weighted directions about +z, on a golden spiral.
std::vector<glm::vec3> hemisphere(int count) {
  std::vector<glm::vec3> directions;
  constexpr float kGoldenAngle = 2.39996323f;
  for (int i = 0; i < count; ++i) {
    const float radius = std::sqrt((static_cast<float>(i) + 0.5f) / static_cast<float>(count));
    const float angle = kGoldenAngle * static_cast<float>(i);
    directions.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                            std::sqrt(1 - radius * radius));
  }
  return directions;
}

float openness(const CubeGrid& grid, const Vertex& vertex, const std::vector<glm::vec3>& directions,
               const OcclusionSettings& settings) {
  const auto [x, y] = frame_around(vertex.normal);
  // Off the surface's own layer of cubes, whichever way it slopes.
  const glm::vec3 start = vertex.position + vertex.normal * (1.8f * settings.cell);
  float hidden = 0;
  for (const glm::vec3 direction : directions) {
    const glm::vec3 ray = direction.x * x + direction.y * y + direction.z * vertex.normal;
    for (float distance = 0; distance < settings.reach; distance += settings.cell) {
      if (grid.is_filled(start + ray * distance)) {
        hidden += 1 - distance / settings.reach;
        break;
      }
    }
  }
  return 1 - settings.strength * hidden / static_cast<float>(directions.size());
}

}  // namespace

void bake_ambient_occlusion(Scene& scene, const OcclusionSettings& settings,
                            const std::function<bool(const Material&)>& takes_part) {
  std::vector<Mesh*> meshes;
  Bounds bounds{glm::vec3(1e9f), glm::vec3(-1e9f)};
  for (const Instance& instance : scene.instances) {
    Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    const bool still = !instance.motion && instance.transform == glm::mat4(1);
    if (!still || material.alpha_mode != AlphaMode::kOpaque || !takes_part(material)) continue;
    meshes.push_back(&mesh);
    for (const Vertex& vertex : mesh.vertices) {
      bounds.low = glm::min(bounds.low, vertex.position);
      bounds.high = glm::max(bounds.high, vertex.position);
    }
  }
  if (meshes.empty()) return;
  CubeGrid grid(bounds, settings.cell);
  for (const Mesh* mesh : meshes) {
    for (std::size_t i = 0; i + 2 < mesh->indices.size(); i += 3) {
      fill_triangle(grid, mesh->vertices[mesh->indices[i]].position,
                    mesh->vertices[mesh->indices[i + 1]].position,
                    mesh->vertices[mesh->indices[i + 2]].position, settings.cell);
    }
  }
  const std::vector<glm::vec3> directions = hemisphere(settings.directions);
  for (Mesh* mesh : meshes) {
    for (Vertex& vertex : mesh->vertices) {
      const float open = openness(grid, vertex, directions, settings);
      // Light that comes round corners has been reflected once more, and so is warmer.
      vertex.colour *= glm::vec4(std::pow(open, 0.92f), open, std::pow(open, 1.08f), 1);
    }
  }
}

}  // namespace quincunx::scenes
