// SPDX-License-Identifier: MIT
// Depth and motion of single samples.
#pragma once

#include "layers/layer.h"
#include "sanitise.h"
#include "texel.h"

#define LAYER_GAP 0.03f     // of the nearer one's depth: surfaces closer together are one layer; .01 and .1 are worse
#define LAYER_MOTION 0.05f  // output pixels a frame: surfaces whose motion differs by less are one layer
#define FARTHEST_MOTION 65504.0f  // pixels a frame: beyond any picture

typedef struct Surface {
  float depth;
  float2 motion;   // output pixels, within +-FARTHEST_MOTION
  bool is_known;   // velocity and depth are finite
} Surface;

// Of sample (x, y), clamped to the edge.
static inline float depth_at(const LayerParams* params, DEPTH_TEXELS depth, int x, int y) {
  const int column = clamp(x, 0, params->width - 1), row = clamp(y, 0, params->height - 1);
  return load_depth(depth, params->depth, column, row);
}

static inline Surface surface_at(const LayerParams* params, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth, int x,
                                 int y) {
  const int column = clamp(x, 0, params->width - 1), row = clamp(y, 0, params->height - 1);
  const float2 moves = load_velocity(velocity, params->velocity, column, row);
  Surface surface;
  surface.depth = depth_at(params, depth, x, y);
  surface.motion = clamp(moves * (float2)(params->motion_x, params->motion_y), -FARTHEST_MOTION, FARTHEST_MOTION);
  surface.is_known = !any_non_finite4((float4)(moves, surface.depth, 0.0f));
  return surface;
}

static inline bool move_apart(float2 a, float2 b) {
  const float2 apart = a - b;
  return dot(apart, apart) > LAYER_MOTION * LAYER_MOTION;
}

// The centre of sample (x, y), output pixels.
static inline float2 place_of(const LayerParams* params, int x, int y) {
  return (float2)((float)x * params->spacing_x + params->start_x, (float)y * params->spacing_y + params->start_y);
}
