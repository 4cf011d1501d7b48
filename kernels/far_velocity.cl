// SPDX-License-Identifier: MIT
// far_velocity: gives the sky its velocity. A sample that is infinitely far away and has a velocity of exactly 0 moves
// as the camera moves its picture; all others keep every bit.
//   params    in   viewport, layouts, camera motion, places
//   depth     in   R32F, viewport, reversed and infinite: 0 at infinity
//   drawn     in   RG16F or RG32F, viewport, in the caller's units
//   motion    in   FAR EVIDENCE: FarModel, from far_fit
//   match     in   FAR EVIDENCE: FarMatch, from far_match: nothing is moved if standing still has the smaller error
//   velocity  out  the same format and units as drawn, viewport; within +-65504
// Options: FAR  CAMERA (default): the camera's motion is given | EVIDENCE: it was fitted
//          SOURCE_STORAGE (of depth and velocities), VELOCITY_FORMAT as in texel.h
// Reference: tests/reference/far_velocity.cpp
#include "bits.h"
#include "motion/camera_velocity.h"
#include "motion/velocity_params.h"
#include "texels/surfaces.h"

#define CAMERA 1
#define EVIDENCE 2
#ifndef FAR
#define FAR CAMERA
#endif
#if FAR != CAMERA && FAR != EVIDENCE
#error "FAR must be CAMERA or EVIDENCE"
#endif

// The error of standing still over that of the motion, below which the former is believed.
#define STILL_IS_BETTER 0.93f

// Which of four samples are far and have no velocity.
static inline int4 far_lanes(float4 depth, float8 drawn) {
  return (fabs(depth) <= FARTHEST_DEPTH) & (drawn.even == 0.0f) & (drawn.odd == 0.0f);
}

// The motion that is believed.
static inline FarModel believed_motion(__global const FarModel* motion, __global const FarMatch* match) {
  FarModel believed = *motion;
  const float still = believed.still + (float)match->still, moved = believed.moved + (float)match->moved;
  const bool moves = believed.is_known && still >= STILL_IS_BETTER * moved;
  for (int i = 0; i < kFarTerms; ++i) believed.p[i] = moves ? believed.p[i] : 0.0f;
  return believed;
}

// Returns the velocities of four samples from (x, y) on, x and y in turn.
static inline float8 modelled_velocities(const FarModel* motion, const FarPlaces* places, int x, int y) {
  return (float8)(far_velocity_at(motion, places, x, y), far_velocity_at(motion, places, x + 1, y),
                  far_velocity_at(motion, places, x + 2, y), far_velocity_at(motion, places, x + 3, y));
}

__kernel void far_velocity(const FarVelocityParams params, DEPTH_TEXELS depth, VELOCITY_TEXELS drawn,
                           __global const FarModel* motion, __global const FarMatch* match, STORED_VELOCITY velocity) {
  const VelocityParams frame = params.frame;
  const int y = get_global_id(1);
  const int first = get_global_id(0) * frame.columns_per_item;
  if (first >= frame.width || y >= frame.height) return;

  const int end = min(first + frame.columns_per_item, frame.width);
  const float2 unit = (float2)(params.to_drawn_x, params.to_drawn_y);
#if FAR == CAMERA
  const float ndc_y = (float)y * frame.camera.step_y + frame.camera.start_y;
#else
  const FarModel believed = believed_motion(motion, match);
#endif
  for (int x = first; x < end; x += kBlock) {
    float8 found = load_velocity_block(drawn, params.drawn, x, y, frame.width);
    const int4 far = far_lanes(load_depth_block(depth, frame.depth, x, y, frame.width), found);
    if (any(far)) {
#if FAR == CAMERA
      const float8 moved = velocity_of(convert_float4(x + (int4)(0, 1, 2, 3)), ndc_y, (float4)(0.0f), &frame.camera);
#else
      const float8 moved = modelled_velocities(&believed, &params.places, x, y);
#endif
      const int8 lanes = (int8)(far.s0, far.s0, far.s1, far.s1, far.s2, far.s2, far.s3, far.s3);
      const float8 units = moved * (float8)(unit, unit, unit, unit);
      found = select(found, clamp(units, -FINITE_HALF_MAX, FINITE_HALF_MAX), lanes);
    }
    store_velocity4(velocity, frame.velocity, x, y, end, found);
  }
}
