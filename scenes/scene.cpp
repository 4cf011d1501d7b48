// SPDX-License-Identifier: MIT
#include "scene.h"

#include <algorithm>
#include <cmath>

namespace quincunx::scenes {
namespace {

// Cuts up to a time, as if the scene had always repeated.
std::int64_t cuts_until(const Scene& scene, double seconds) {
  const double round = std::floor(seconds / scene.duration);
  const double within = seconds - round * scene.duration;
  const auto passed = std::upper_bound(scene.cuts.begin(), scene.cuts.end(), within) - scene.cuts.begin();
  return static_cast<std::int64_t>(round) * static_cast<std::int64_t>(scene.cuts.size()) + passed;
}

}  // namespace

SceneNeeds needs_of(const Scene& scene) {
  SceneNeeds needs;
  needs.moving_objects =
      std::any_of(scene.instances.begin(), scene.instances.end(),
                  [](const Instance& instance) { return static_cast<bool>(instance.motion); });
  needs.camera_motion = scene.camera_moves;
  const auto is_blended = [&](const Instance& instance) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    return scene.materials[static_cast<std::size_t>(mesh.material)].alpha_mode == AlphaMode::kBlend;
  };
  needs.transparents = static_cast<bool>(scene.particles) ||
                       std::any_of(scene.instances.begin(), scene.instances.end(), is_blended);
  needs.background = scene.sky.background != Background::kNone;
  return needs;
}

bool is_cut(const Scene& scene, double previous_seconds, double seconds) {
  return cuts_until(scene, previous_seconds) != cuts_until(scene, seconds);
}

bool shows(const Scene& scene, const Fault& fault, double previous_seconds, double seconds) {
  const auto rounds = [&](double now) { return std::floor((now - fault.seconds) / scene.duration); };
  return rounds(seconds) > rounds(previous_seconds);
}

std::optional<double> next_cut(const Scene& scene, double seconds) {
  if (scene.cuts.empty()) return std::nullopt;
  const double round = std::floor(seconds / scene.duration) * scene.duration;
  const auto next = std::lower_bound(scene.cuts.begin(), scene.cuts.end(), seconds - round);
  return next != scene.cuts.end() ? round + *next : round + scene.duration + scene.cuts.front();
}

Bounds bounds_of(const Scene& scene) {
  std::vector<Bounds> boxes(scene.meshes.size());
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    const std::vector<Vertex>& vertices = scene.meshes[m].vertices;
    if (vertices.empty()) continue;
    boxes[m] = {vertices[0].position, vertices[0].position};
    for (const Vertex& vertex : vertices) {
      boxes[m].low = glm::min(boxes[m].low, vertex.position);
      boxes[m].high = glm::max(boxes[m].high, vertex.position);
    }
  }
  Bounds bounds;
  bool first = true;
  for (const Instance& instance : scene.instances) {
    const auto mesh = static_cast<std::size_t>(instance.mesh);
    if (scene.meshes[mesh].vertices.empty()) continue;
    const Bounds box = transformed(boxes[mesh], instance.motion ? instance.motion(0) : instance.transform);
    bounds.low = first ? box.low : glm::min(bounds.low, box.low);
    bounds.high = first ? box.high : glm::max(bounds.high, box.high);
    first = false;
  }
  return bounds;
}

Bounds transformed(const Bounds& box, const glm::mat4& transform) {
  const glm::vec3 centre = 0.5f * (box.low + box.high);
  const glm::vec3 half = 0.5f * (box.high - box.low);
  const auto new_centre = glm::vec3(transform * glm::vec4(centre, 1));
  const glm::vec3 new_half = glm::abs(glm::vec3(transform[0])) * half.x +
                             glm::abs(glm::vec3(transform[1])) * half.y +
                             glm::abs(glm::vec3(transform[2])) * half.z;
  return {new_centre - new_half, new_centre + new_half};
}

}  // namespace quincunx::scenes
