// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene.h"

namespace quincunx::scenes {

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
