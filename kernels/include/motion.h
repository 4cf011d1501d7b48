// SPDX-License-Identifier: MIT
// Streaks: how far a surface moves over the output while the shutter is open, in whole units of 1 / kStreakUnits output
// pixels, so that every device finds the same samples.
#pragma once

#include "sanitise.h"
#include "texel.h"

// Two streaks, x and y in turn for each of four texels, from velocities in the units of their target. NaN and Inf are 0.
static inline int8 streaks_of(float8 velocity, float scale_x, float scale_y) {
  const float8 scaled = velocity * (float8)(scale_x, scale_y, scale_x, scale_y, scale_x, scale_y, scale_x, scale_y);
  const int8 bits = as_int8(velocity);
  const float8 settled = as_float8(select(as_int8(scaled), (int8)(0), (bits & 0x7fffffff) >= NON_FINITE_BITS));
  return convert_int8(clamp(settled, (float)-kLongestStreak, (float)kLongestStreak));
}

// Of four texels anywhere.
static inline float8 gather_velocity(VELOCITY_TEXELS texels, TexelLayout layout, int4 x, int4 y) {
#if SOURCE_STORAGE == IMAGE
  return (float8)(read_imagef(texels, (int2)(x.s0, y.s0)).xy, read_imagef(texels, (int2)(x.s1, y.s1)).xy,
                  read_imagef(texels, (int2)(x.s2, y.s2)).xy, read_imagef(texels, (int2)(x.s3, y.s3)).xy);
#else
  const int4 at = y * layout.pitch + (x + layout.offset);
#if VELOCITY_FORMAT == HALF
  __global const uint* pairs = (__global const uint*)texels;
  const uint4 bits = (uint4)(pairs[at.s0], pairs[at.s1], pairs[at.s2], pairs[at.s3]);
  return vload_half8(0, (__private const half*)&bits);
#else
  return (float8)(vload2(at.s0, texels), vload2(at.s1, texels), vload2(at.s2, texels), vload2(at.s3, texels));
#endif
#endif
}

// NaN and negative depths count as infinitely far.
static inline float4 gather_depth(DEPTH_TEXELS texels, TexelLayout layout, int4 x, int4 y) {
#if SOURCE_STORAGE == IMAGE
  const float4 depth = (float4)(read_imagef(texels, (int2)(x.s0, y.s0)).x, read_imagef(texels, (int2)(x.s1, y.s1)).x,
                                read_imagef(texels, (int2)(x.s2, y.s2)).x, read_imagef(texels, (int2)(x.s3, y.s3)).x);
#else
  const int4 at = y * layout.pitch + (x + layout.offset);
  const float4 depth = (float4)(texels[at.s0], texels[at.s1], texels[at.s2], texels[at.s3]);
#endif
  const int4 bits = as_int4(depth);
  return as_float4(select((int4)(0), bits, (bits > 0) & (bits <= 0x7f800000)));
}
