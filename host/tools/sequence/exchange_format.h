// SPDX-License-Identifier: MIT
// Exchange format: the arithmetic between what the renderer holds and what an EXR sequence says
// (docs/inputs.md). Pure; thread-safe.
#pragma once

#include "quincunx/extent.h"

namespace quincunx::tools {

// `Z` where no surface was seen: finite, so that a filter over Z makes no NaN, far beyond any scene, and what
// Blender writes there.
constexpr float kNoSurfaceZ = 1e10f;

// Reversed infinite depth (1 at the near plane, 0 at infinity) to linear distance along the view axis, in the
// unit of `near_plane`. 0, negative and not-a-number depths, and surfaces beyond kNoSurfaceZ, give
// kNoSurfaceZ.
float linear_z(float depth, float near_plane);

// The way back: a Z that is not below kNoSurfaceZ, or not a number, is depth 0; one before the near plane
// is 1.
float reversed_depth(float z, float near_plane);

// uv velocity (this position - previous position, +y down) to `backward.u`, `backward.v`: previous - current
// in pixels of an image of this extent, +v up.
Vec2 backward_from_velocity(Vec2 velocity, Extent extent);
Vec2 velocity_from_backward(Vec2 backward, Extent extent);

}  // namespace quincunx::tools
