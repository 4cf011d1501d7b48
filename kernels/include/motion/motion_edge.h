// SPDX-License-Identifier: MIT
// Motion edges: where the velocities of neighbouring samples differ, by how many output pixels a frame. History between
// the texels on both sides of one mixes two surfaces.
#pragma once

// Thresholds in output pixels a frame, both ranges found by search on the development scenes. Below the first
// difference an edge has no effect; the effect rises smoothly and is whole from the second on.
#define EDGE_REJECTS_FROM 0.15f  // history is brought into the range of this frame's samples
#define EDGE_REJECTS_ALL 0.6f
#define EDGE_COSTS_FROM 0.1f     // history loses confidence
#define EDGE_COSTS_ALL 1.0f

static inline float8 smooth_step(float8 x, float low, float high) {
  const float8 t = clamp((x - low) * (1.0f / (high - low)), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

// How far a motion edge has history rejected, 0 to 1.
static inline float8 edge_rejection(float8 motion_edge) {
  return smooth_step(motion_edge, EDGE_REJECTS_FROM, EDGE_REJECTS_ALL);
}
