// SPDX-License-Identifier: MIT
// Streaks: how far a surface moves over the output while the shutter is open, in whole units of 1 / kStreakUnits output
// pixels, so that every device finds the same samples.
#pragma once

#include "bits.h"
#include "motion/blur_params.h"
#include "texels/surfaces.h"

// Two streaks, x and y in turn for each of four texels, from velocities in the units of their target. NaN and Inf are
//                         0.
static inline int8 streaks_of(float8 velocity, float scale_x, float scale_y) {
  const float8 scaled = velocity * (float8)(scale_x, scale_y, scale_x, scale_y, scale_x, scale_y, scale_x, scale_y);
  const int8 bits = as_int8(velocity);
  const float8 settled = as_float8(select(as_int8(scaled), (int8)(0), (bits & 0x7fffffff) >= NON_FINITE_BITS));
  return convert_int8(clamp(settled, (float)-kLongestStreak, (float)kLongestStreak));
}

// One axis of streaks in lanes.
static inline LaneInt streak_lanes(LaneFloat velocity, float scale) {
  const LaneFloat settled =
      select(velocity * scale, (LaneFloat)(0.0f), magnitude_bits(velocity) >= NON_FINITE_BITS);
  return to_lane_int(clamp(settled, (float)-kLongestStreak, (float)kLongestStreak));
}

// The depths of texels anywhere; NaN and negative ones count as infinitely far.
static inline LaneFloat load_settled_depths_at(DEPTH_TEXELS texels, TexelLayout layout, LaneInt x, LaneInt y) {
  const LaneInt bits = as_lane_int(load_depths_at(texels, layout, x, y));
  return as_lane_float(select((LaneInt)(0), bits, (bits > 0) & (bits <= 0x7f800000)));
}
