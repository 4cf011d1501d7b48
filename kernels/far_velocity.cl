// SPDX-License-Identifier: MIT
// far_velocity: the velocity that was drawn, and that of the sky where none was: a sample that is infinitely far away
// and has a velocity of exactly 0 gets what the camera's motion gives it there. All others keep every bit.
//   params    in   viewport, layouts, camera motion
//   depth     in   R32F, viewport, reversed and infinite: 0 at infinity
//   drawn     in   RG16F or RG32F, viewport, in the caller's units
//   velocity  out  the same format and units, viewport; within +-65504
// Options: SOURCE_STORAGE (of all three), VELOCITY_FORMAT as in texel.h
// Reference: tests/reference/far_velocity.cpp
#include "motion/camera_velocity.h"
#include "texel_blocks.h"

// Reversed depth: nothing beyond is told from infinity. Files with linear depth have 1e10 where nothing was seen.
#define FARTHEST_DEPTH 1e-9f

// Which of four samples are far and have no velocity.
static inline int4 is_still_and_far(float4 depth, float8 drawn) {
  return (fabs(depth) <= FARTHEST_DEPTH) & (drawn.even == 0.0f) & (drawn.odd == 0.0f);
}

__kernel void far_velocity(const FarVelocityParams params, DEPTH_TEXELS depth, VELOCITY_TEXELS drawn,
                           STORED_VELOCITY velocity) {
  const VelocityParams frame = params.frame;
  const int y = get_global_id(1);
  const int first = get_global_id(0) * frame.columns_per_item;
  if (first >= frame.width || y >= frame.height) return;

  const int end = min(first + frame.columns_per_item, frame.width);
  const float ndc_y = (float)y * frame.camera.step_y + frame.camera.start_y;
  const float2 unit = (float2)(params.to_drawn_x, params.to_drawn_y);
  for (int x = first; x < end; x += kBlock) {
    float8 found = load_velocity_block(drawn, params.drawn, x, y, frame.width);
    const int4 far = is_still_and_far(load_depth_block(depth, frame.depth, x, y, frame.width), found);
    if (any(far)) {
      const float4 column = convert_float4(x + (int4)(0, 1, 2, 3));
      const float8 moved = velocity_of(column, ndc_y, (float4)(0.0f), &frame.camera) * (float8)(unit, unit, unit, unit);
      const int8 lanes = (int8)(far.s0, far.s0, far.s1, far.s1, far.s2, far.s2, far.s3, far.s3);
      found = select(found, clamp(moved, -LARGEST_VELOCITY, LARGEST_VELOCITY), lanes);
    }
    store_velocity4(velocity, frame.velocity, x, y, end, found);
  }
}
