// SPDX-License-Identifier: MIT
// Geometry: depth and motion of one frame at output size, from which the masks of the truth are made.
#pragma once

#include <vector>

#include "quincunx/extent.h"
#include "quincunx_gl/render_targets.h"
#include "render/renderer.h"

namespace quincunx::bench {

// At the centre of each pixel. Depth is reversed and infinite: 1 near, 0 far; velocity is uv, this position - previous
// position. The background, at depth 0, has the velocity that the camera gives it, whatever the scene says of it.
struct Geometry {
  Extent extent;
  std::vector<float> depth;
  std::vector<Vec2> velocity;
};

// A surface is nearer than another where its depth exceeds the other's this many times. A twentieth: more than a
// surface at walking pace comes nearer in a frame, less than an object stands before its background.
inline constexpr float kNearer = 1.05f;
inline constexpr float kHorizon = 1e-6f;  // depth above this is a surface

// Whether `depth` is of a surface that stands before `other`.
bool is_nearer(float depth, float other);

// `targets` have the extent wanted, and velocity.
Result<Geometry> geometry_at(scenes::Renderer& renderer, const gl::RenderTargets& targets, double seconds,
                             double previous_seconds);

// Of each pixel the depth of the nearest of 3 x 3 samples: what is thinner than a pixel is not missed.
Result<std::vector<float>> nearest_depth_at(scenes::Renderer& renderer, const gl::RenderTargets& targets,
                                            double seconds);

}  // namespace quincunx::bench
