// SPDX-License-Identifier: MIT
#include "render/shadow_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quincunx::scenes {
namespace {

constexpr int kCameraLooks = 8;            // places of the camera over the duration
constexpr double kFittedTriangles = 0.95;  // part of all triangles that the fit follows
constexpr float kSpare = 1.25f;            // radius beyond those

std::vector<glm::vec3> camera_places(const Scene& scene) {
  std::vector<glm::vec3> places;
  for (int i = 0; i <= kCameraLooks; ++i) {
    places.emplace_back(scene.camera(scene.duration * i / kCameraLooks).world_from_camera[3]);
  }
  return places;
}

float distance_to(const std::vector<glm::vec3>& places, const glm::vec3& point) {
  float nearest = std::numeric_limits<float>::max();
  for (const glm::vec3& place : places)
    nearest = std::min(nearest, glm::distance(place, point));
  return nearest;
}

// Distance from the camera within which most triangles lie.
float radius_of_interest(const std::vector<std::pair<float, double>>& casters) {
  double total = 0;
  for (const auto& [distance, triangles] : casters)
    total += triangles;
  double sum = 0;
  for (const auto& [distance, triangles] : casters) {
    sum += triangles;
    if (sum >= kFittedTriangles * total) return distance * kSpare;
  }
  return 0;
}

glm::mat4 light_axes(const glm::vec3& along) {
  const glm::vec3 helper = std::abs(along.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  const glm::vec3 right = glm::normalize(glm::cross(helper, along));
  return glm::transpose(glm::mat4(glm::vec4(right, 0), glm::vec4(glm::cross(along, right), 0),
                                  glm::vec4(along, 0), glm::vec4(0, 0, 0, 1)));
}

glm::vec3 centre_of(const Bounds& box) {
  return 0.5f * (box.low + box.high);
}

}  // namespace

int shadow_side(float scale) {
  return 2 * static_cast<int>(std::lround(scale * kShadowTexels / 2));
}

ShadowFit fit_shadow(const Scene& scene, const std::vector<ShadowCaster>& casters) {
  ShadowFit fit;
  const bool sun = scene.sun.irradiance != glm::vec3(0) && scene.sun.direction != glm::vec3(0);
  if (!scene.sun.casts_shadows || !sun || casters.empty()) return fit;

  const std::vector<glm::vec3> places = camera_places(scene);
  std::vector<std::pair<float, double>> by_distance;
  for (const ShadowCaster& c : casters)
    by_distance.emplace_back(distance_to(places, centre_of(c.box)), c.triangles);
  std::sort(by_distance.begin(), by_distance.end());
  const float radius = radius_of_interest(by_distance);

  const glm::mat4 light_from_world = light_axes(glm::normalize(scene.sun.direction));
  Bounds box;
  for (const ShadowCaster& caster : casters) {
    if (distance_to(places, centre_of(caster.box)) > radius) continue;
    // A huge thing counts as far as it is near.
    const Bounds near_part{glm::max(caster.box.low, places[0] - 2 * radius),
                           glm::min(caster.box.high, places[0] + 2 * radius)};
    if (glm::any(glm::lessThan(near_part.high, near_part.low))) continue;
    const Bounds seen = transformed(near_part, light_from_world);
    box.low = fit.enabled ? glm::min(box.low, seen.low) : seen.low;
    box.high = fit.enabled ? glm::max(box.high, seen.high) : seen.high;
    fit.enabled = true;
  }
  if (!fit.enabled) return fit;
  const glm::vec3 size = glm::max(box.high - box.low, glm::vec3(1e-3f)) * 1.01f;
  const glm::vec3 low = centre_of(box) - 0.5f * size;
  fit.texel_metres = std::max(size.x, size.y) / kShadowTexels;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      fit.shadow_from_world[column][row] = light_from_world[column][row] / size[row];
    }
    fit.shadow_from_world[3][row] -= low[row] / size[row];
  }
  return fit;
}

}  // namespace quincunx::scenes
