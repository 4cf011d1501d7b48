// SPDX-License-Identifier: MIT
#include "render/view_math.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quincunx::scenes {
namespace {

// From clip space of the whole picture to that of a part.
void look_through(const ViewWindow& window, ViewMatrices& view) {
  const glm::dvec2 centre(2 * window.corner.x + window.size.x - 1, 1 - 2 * window.corner.y - window.size.y);
  glm::dmat4 closer(1);
  closer[0][0] = 1 / window.size.x;
  closer[1][1] = 1 / window.size.y;
  closer[3] = {-centre / window.size, 0, 1};
  glm::dmat4 back(1);
  back[0][0] = window.size.x;
  back[1][1] = window.size.y;
  back[3] = {centre, 0, 1};
  view.clip_from_camera = closer * view.clip_from_camera;
  view.camera_from_clip = view.camera_from_clip * back;
}

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

ViewMatrices view_of(const Camera& camera, float aspect, const ViewWindow& window) {
  ViewMatrices view;
  view.world_from_camera = camera.world_from_camera;
  view.camera_from_world = glm::inverse(view.world_from_camera);
  const double focal = 1.0 / std::tan(0.5 * static_cast<double>(camera.vertical_fov));
  const double focal_x = focal / static_cast<double>(aspect);
  const double near_plane = camera.near_plane;
  // Columns: clip = (focal_x x, focal y, near, -z).
  view.clip_from_camera = glm::dmat4(0);
  view.clip_from_camera[0][0] = focal_x;
  view.clip_from_camera[1][1] = focal;
  view.clip_from_camera[2][3] = -1;
  view.clip_from_camera[3][2] = near_plane;
  view.camera_from_clip = glm::dmat4(0);
  view.camera_from_clip[0][0] = 1 / focal_x;
  view.camera_from_clip[1][1] = 1 / focal;
  view.camera_from_clip[2][3] = 1 / near_plane;
  view.camera_from_clip[3][2] = -1;
  if (window != ViewWindow{}) look_through(window, view);
  return view;
}

glm::mat4 clip_to_previous_clip(const ViewMatrices& now, const ViewMatrices& before) {
  if (now.world_from_camera == before.world_from_camera && now.clip_from_camera == before.clip_from_camera) {
    return glm::mat4(1);
  }
  return before.clip_from_camera * (before.camera_from_world * now.world_from_camera) * now.camera_from_clip;
}

CameraMotion camera_motion_between(const ViewMatrices& now, const ViewMatrices& before) {
  const glm::mat4 matrix = clip_to_previous_clip(now, before);
  CameraMotion motion;
  for (int i = 0; i < 16; ++i)
    motion.clip_to_previous_clip[static_cast<std::size_t>(i)] = matrix[i / 4][i % 4];
  return motion;
}

Frustum::Frustum(const glm::mat4& clip_from_world, float margin) {
  const glm::mat4 rows = glm::transpose(clip_from_world);
  const glm::vec4 widened = rows[3] * (1 + margin);
  planes_ = {widened + rows[0], widened - rows[0], widened + rows[1], widened - rows[1], rows[3] - rows[2]};
}

bool Frustum::may_see(const Bounds& box) const {
  return std::all_of(planes_.begin(), planes_.end(), [&](const glm::vec4& plane) {
    const glm::vec3 farthest(plane.x > 0 ? box.high.x : box.low.x, plane.y > 0 ? box.high.y : box.low.y,
                             plane.z > 0 ? box.high.z : box.low.z);
    return glm::dot(glm::vec3(plane), farthest) + plane.w >= 0;
  });
}

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
