// SPDX-License-Identifier: MIT
// Motion edges, and the options of the kernels that follow surfaces.
//
//   MOTION    1 (default): they read what reproject wrote | 0: nothing moves
//   REACTIVE  0 (default) | 1: they read reactive values themselves
#pragma once

#include "lanes.h"
#include "temporal/constants.h"

#ifndef MOTION
#define MOTION 1
#endif
#ifndef REACTIVE
#define REACTIVE 0
#endif
#if MOTION < 0 || MOTION > 1
#error "MOTION must be 0 or 1"
#endif
#if REACTIVE < 0 || REACTIVE > 1
#error "REACTIVE must be 0 or 1"
#endif

// A motion edge lies where the velocities of neighbouring samples differ, by so many output pixels a frame. History
// between the texels on both sides of one mixes two surfaces. Up to the first of two limits in temporal/constants.h it
// has no effect, from the second on all of it.

// Returns 0 up to `low`, 1 from `high` on, and a smooth rise between.
static inline LaneFloat smooth_step(LaneFloat x, float low, float high) {
  const LaneFloat t = clamp((x - low) * (1.0f / (high - low)), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

// Returns how far a motion edge has history rejected, 0 to 1.
static inline LaneFloat edge_rejection(LaneFloat motion_edge) {
  return smooth_step(motion_edge, REJECTED_EDGE_MIN, REJECTED_EDGE_MAX);
}
