// SPDX-License-Identifier: MIT
// Ambient occlusion for procedural scenes, computed once, into vertex colours.
#pragma once

#include <functional>

#include "scene.h"

namespace quincunx::scenes {

struct OcclusionSettings {
  float cell = 0.16f;     // metres: size of the cubes that the scene is measured in
  float reach = 2.6f;     // metres: what is further away does not darken
  int directions = 32;    // over the hemisphere, cosine weighted
  float strength = 0.9f;  // 0: nothing happens, 1: a closed corner turns black
};

// Multiplies the vertex colours of the meshes that stand still once, untransformed, by how open the sky is to
// them. Only opaque materials hide and are darkened, and only where `takes_part(material)` holds. Small, slow
// and simple: a bit per cube, marched through; meant for 1e5 vertices and some seconds at most.
void bake_ambient_occlusion(Scene& scene, const OcclusionSettings& settings,
                            const std::function<bool(const Material&)>& takes_part);

}  // namespace quincunx::scenes
