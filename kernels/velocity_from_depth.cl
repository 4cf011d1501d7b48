// SPDX-License-Identifier: MIT
// velocity_from_depth: computes the velocity that a moving camera gives a still scene, from depth.
//   params    in   viewport, layouts, camera motion
//   depth     in   R32F, viewport, reversed and infinite: 1 at the near plane, 0 at infinity
//   velocity  out  RG16F or RG32F, viewport: this position - the previous one, uv, jitter excluded
// A surface that was not before the previous camera, or moved further than that, has +-65504. Depth that is not finite
// gives NaN: the passes that read it count it and trust no history there.
// Options: SOURCE_STORAGE (of both), VELOCITY_FORMAT as in texel.h
// Reference: tests/reference/velocity_from_depth.cpp
#include "bits.h"
#include "motion/camera_velocity.h"
#include "motion/velocity_params.h"
#include "texel.h"

__kernel void velocity_from_depth(const VelocityParams params, DEPTH_TEXELS depth, STORED_VELOCITY velocity) {
  const int y = get_global_id(1);
  const int first = get_global_id(0) * params.columns_per_item;
  if (first >= params.width || y >= params.height) return;

  const int end = min(first + params.columns_per_item, params.width);
  const float ndc_y = (float)y * params.camera.step_y + params.camera.start_y;
  for (int x = first; x < end; x += kBlock) {
    const int4 column = x + (int4)(0, 1, 2, 3);
    const float4 input = load_depth_block(depth, params.depth, x, y, params.width);
    const int4 lost = non_finite_lanes(input);
    const float4 settled = as_float4(select(as_int4(input), (int4)(0), lost));
    const float8 moved = velocity_of(convert_float4(column), ndc_y, settled, &params.camera);
    const int8 lost_pairs = (int8)(lost.s0, lost.s0, lost.s1, lost.s1, lost.s2, lost.s2, lost.s3, lost.s3);
    const float8 found = as_float8(select(as_int8(moved), (int8)(0x7fc00000), lost_pairs));
    store_velocity4(velocity, params.velocity, x, y, end, found);
  }
}
