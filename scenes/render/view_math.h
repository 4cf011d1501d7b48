// SPDX-License-Identifier: MIT
// Cameras and the sun's shadow map as matrices. Pure functions.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "quincunx/frame.h"
#include "scene.h"

namespace quincunx::scenes {

// A part of the picture: its upper left corner and its size, in parts of the picture's width and height.
struct ViewWindow {
  glm::dvec2 corner{0};
  glm::dvec2 size{1};

  friend bool operator==(const ViewWindow&, const ViewWindow&) = default;
};

// A camera's matrices, in double precision. Clip space: x right, y up, depth = z / w from 1 at the near plane to 0 at
// infinity (reversed, infinite).
struct ViewMatrices {
  glm::dmat4 world_from_camera{1};
  glm::dmat4 camera_from_world{1};
  glm::dmat4 clip_from_camera{1};
  glm::dmat4 camera_from_clip{1};

  glm::mat4 clip_from_world() const { return clip_from_camera * camera_from_world; }
};

// `window`: the part of the picture that fills clip space; `aspect` is the whole picture's.
ViewMatrices view_of(const Camera& camera, float aspect, const ViewWindow& window = {});

// (ndc.x, ndc.y, depth, 1) of `now` to homogeneous clip coordinates of `before`. Exactly the identity where
// the two are equal.
glm::mat4 clip_to_previous_clip(const ViewMatrices& now, const ViewMatrices& before);
CameraMotion camera_motion_between(const ViewMatrices& now, const ViewMatrices& before);

// Left, right, bottom, top and near plane; inside is positive. There is no far plane.
class Frustum {
 public:
  // `margin`: part of the half viewport to add on each side, for jitter.
  Frustum(const glm::mat4& clip_from_world, float margin);
  bool may_see(const Bounds& box) const;

 private:
  std::array<glm::vec4, 5> planes_;
};

inline constexpr int kShadowTexels = 2048;  // side of the shadow map

// The side in texels of the map's part that a frame with this scale, in [kLeastPartScale, 1], draws and reads: even.
int shadow_side(float scale);

// The sun's orthographic view of what casts shadows, fixed for the scene so that shadows never crawl.
struct ShadowFit {
  bool enabled = false;
  bool moves = false;              // some caster moves
  glm::mat4 shadow_from_world{1};  // to (u, v, depth), each within [0, 1] for the casters that were fitted
  float texel_metres = 0;          // world size of a texel of the whole map, the larger side
};

struct ShadowCaster {
  Bounds box;  // world, over all time
  double triangles = 0;
};

// Fits the map to the casters near the camera's path: the nearest that hold most of the triangles, so that a
// distant range of hills takes no texels from a courtyard. What lies beyond is lit.
ShadowFit fit_shadow(const Scene& scene, const std::vector<ShadowCaster>& casters);

}  // namespace quincunx::scenes
