// SPDX-License-Identifier: MIT
// Streaks: how far a surface moves over the output while the shutter is open, in whole units of 1 / kStreakUnits output
// pixels, so that every device finds the same samples.
#pragma once

#include "bits.h"
#include "motion/blur_params.h"
#include "texels/surfaces.h"

// One axis of streaks, from velocities in the units of their target. NaN and Inf are 0.
#define DEFINE_STREAKS(name, floats, ints, as_ints, to_ints)                                            \
  static inline ints name(floats velocity, float scale) {                                               \
    const floats settled =                                                                              \
        select(velocity * scale, (floats)(0.0f), (as_ints(velocity) & 0x7fffffff) >= NON_FINITE_BITS);  \
    return to_ints(clamp(settled, (float)-kLongestStreak, (float)kLongestStreak));                      \
  }
DEFINE_STREAKS(streaks_of_four, float4, int4, as_int4, convert_int4)
DEFINE_STREAKS(streak_lanes, LaneFloat, LaneInt, as_lane_int, to_lane_int)

// The depths of texels anywhere; NaN and negative ones count as infinitely far.
static inline LaneFloat load_settled_depths_at(DEPTH_TEXELS texels, TexelLayout layout, LaneInt x, LaneInt y) {
  const LaneInt bits = as_lane_int(load_depths_at(texels, layout, x, y));
  return as_lane_float(select((LaneInt)(0), bits, (bits > 0) & (bits <= 0x7f800000)));
}
