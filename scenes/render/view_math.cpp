// SPDX-License-Identifier: MIT
#include "render/view_math.h"

#include <algorithm>
#include <cmath>

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

}  // namespace quincunx::scenes
