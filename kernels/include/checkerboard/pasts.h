// SPDX-License-Identifier: MIT
// For resolve_checkerboard: where the surfaces of eight pixels were in the previous frame, and how far that is to be
// trusted.
#pragma once

#include "bits.h"
#include "checkerboard/surfaces.h"
#include "motion/camera_velocity.h"
#include "texels/surfaces.h"

// Tolerances within which a previous depth is the surface's, found on the bench's scenes.
#define DEPTH_TOLERANCE 0.02f      // fraction of the surface's reversed depth
#define RANGE_TOLERANCE 0.5f       // fraction of the difference of nearest and farthest neighbour
#define LEAST_TOLERANCE 1e-9f      // reversed depth that is not told from infinity

typedef struct VelocitiesAround {
  VelocityBits left, right, above, below;
} VelocitiesAround;

static inline VelocitiesAround velocities_around(const CheckerboardParams* params, VELOCITY_TEXELS texels, int x,
                                                 int y) {
  const TexelLayout layout = params->shaded.velocity;
  const VelocitiesAround velocities = {
      load_every_other_velocity(texels, layout, x - 1, y, params->width),
      load_every_other_velocity(texels, layout, x + 1, y, params->width),
      load_every_other_velocity(texels, layout, x, row_above(y), params->width),
      load_every_other_velocity(texels, layout, x, row_below(params, y), params->width)};
  return velocities;
}

static inline VelocityBits velocity_on(Sides side, VelocitiesAround velocities) {
#if SOURCE_STORAGE == BUFFER && VELOCITY_FORMAT == HALF
  const uint8 is_second = as_uint8(side << 31), is_down = as_uint8(side << 30);
#else
  const ulong8 is_second = convert_ulong8(as_uint8(side)) << 63, is_down = convert_ulong8(as_uint8(side)) << 62;
#endif
  const VelocityBits across = select(velocities.left, velocities.right, is_second);
  const VelocityBits down = select(velocities.above, velocities.below, is_second);
  return select(across, down, is_down);
}

// Velocity on one axis each, in its own units.
typedef struct Motion {
  float8 x, y;
} Motion;

static inline Motion motion_of(VelocityBits bits) {
#if SOURCE_STORAGE == BUFFER && VELOCITY_FORMAT == HALF
  __private const half* halves = (__private const half*)&bits;
  const float16 both = (float16)(vload_half8(0, halves), vload_half8(1, halves));
#else
  const float16 both = as_float16(bits);
#endif
  const Motion motion = {both.even, both.odd};
  return motion;
}

static inline Motion no_motion() {
  const Motion motion = {(float8)(0.0f), (float8)(0.0f)};
  return motion;
}

static inline Motion camera_motion(const CheckerboardParams* params, int x, int y, float8 depth) {
  const float8 column = convert_float8(every_other(x));
  const float ndc_y = (float)y * params->camera.step_y + params->camera.start_y;
  const float8 first = velocity_of(column.lo, ndc_y, depth.lo, &params->camera);
  const float8 last = velocity_of(column.hi, ndc_y, depth.hi, &params->camera);
  const Motion motion = {(float8)(first.even, last.even), (float8)(first.odd, last.odd)};
  return motion;
}

// On one axis: texels on both sides of a place, and how far it is from the lower one to the next. Not clamped.
typedef struct Between {
  int8 low;
  float8 fraction;
} Between;

static inline Between between_texels(float8 at) {
  int8 low = convert_int8(at);
  low += convert_float8(low) > at;  // towards minus infinity
  const Between between = {low, at - convert_float8(low)};
  return between;
}

// The texels to read on both sides, clamped to the edge; one and the same where the place is a texel's own.
static inline int8 lower_texel(Between between, int size) {
  return clamp(between.low, (int8)(0), (int8)(size - 1));
}

static inline int8 upper_texel(Between between, int size) {
  return clamp(between.low - (between.fraction > 0.0f), (int8)(0), (int8)(size - 1));
}

// Where eight pixels were in the previous frame.
typedef struct Places {
  Between column, row;
  bool are_a_run;  // their texels on both sides are those of a run of sixteen in each of two rows
} Places;

static inline Places places_at(const CheckerboardParams* params, float8 x, float8 y) {
  Places places = {between_texels(x), between_texels(y), false};
  const int8 apart = (places.column.low - every_other(places.column.low.s0)) | (places.row.low - places.row.low.s0);
  places.are_a_run = !any_of_eight(apart) && run_is_inside(places.column.low.s0, params->previous_width);
  return places;
}

// The two rows of a run.
static inline int upper_row(const CheckerboardParams* params, Places places) {
  return clamp(places.row.low.s0, 0, params->previous_height - 1);
}

static inline int lower_row(const CheckerboardParams* params, Places places) {
  return clamp(places.row.low.s0 + 1, 0, params->previous_height - 1);
}

static inline float8 load_depth_at8(DEPTH_TEXELS depth, TexelLayout layout, int8 x, int8 y) {
  return (float8)(load_depth_at(depth, layout, x.lo, y.lo), load_depth_at(depth, layout, x.hi, y.hi));
}

static inline float8 mix_depths(float8 low, float8 high, float8 fraction) {
  return low + (high - low) * fraction;
}

// The previous depth at eight places, linear between texels.
static inline float8 depth_between(const CheckerboardParams* params, DEPTH_TEXELS depth, Places places) {
  const TexelLayout layout = params->previous_depth;
#if SOURCE_STORAGE == BUFFER
  if (ON_CPU && places.are_a_run) {
    const float16 upper = vload16(0, depth + texel_index(layout, places.column.low.s0, upper_row(params, places)));
    const float16 lower = vload16(0, depth + texel_index(layout, places.column.low.s0, lower_row(params, places)));
    const float8 held = mix_depths(mix_depths(upper.even, upper.odd, places.column.fraction),
                                   mix_depths(lower.even, lower.odd, places.column.fraction), places.row.fraction);
    if (!any_of_eight(non_finite_depths(held))) return held;  // else a texel may count that has no part in it
  }
#endif
  const int8 left = lower_texel(places.column, params->previous_width);
  const int8 right = upper_texel(places.column, params->previous_width);
  const int8 above = lower_texel(places.row, params->previous_height);
  const int8 below = upper_texel(places.row, params->previous_height);
  return mix_depths(mix_depths(load_depth_at8(depth, layout, left, above), load_depth_at8(depth, layout, right, above),
                               places.column.fraction),
                    mix_depths(load_depth_at8(depth, layout, left, below), load_depth_at8(depth, layout, right, below),
                               places.column.fraction),
                    places.row.fraction);
}

// 1 inside [low, low + length], 0 from a pixel away on.
static inline float8 inside_previous(float8 at, float low, float length) {
  return clamp(1.0f - max(low - at, at - (low + length)), 0.0f, 1.0f);
}

typedef struct Past {
  Places places;
  float8 trust;
} Past;

static inline Past no_past() {
  const Between nowhere = {(int8)(0), (float8)(0.0f)};
  const Past past = {{nowhere, nowhere, false}, (float8)(0.0f)};
  return past;
}

// Returns the past of surfaces of these depths and motions; `whole`: trust where all agrees.
IN_REGISTERS static inline Past past_of(const CheckerboardParams* params, DEPTH_TEXELS previous, int x, int y,
                                        float8 depth, Motion motion, int8 is_surface, float8 range, float8 whole) {
  const int8 known = is_surface & ~non_finite_depths(motion.x) & ~non_finite_depths(motion.y);
  const float8 moved_x = as_float8(as_int8(motion.x) & known) * params->motion_x;
  const float8 moved_y = as_float8(as_int8(motion.y) & known) * params->motion_y;
  const float8 at_x = convert_float8(every_other(x)) * params->step_x + params->start_x +
                      clamp(moved_x, -FINITE_HALF_MAX, FINITE_HALF_MAX);
  const float8 at_y =
      (float)y * params->step_y + params->start_y + clamp(moved_y, -FINITE_HALF_MAX, FINITE_HALF_MAX);
  Past past;
  past.places = places_at(params, at_x, at_y);
  const float8 before = depth_between(params, previous, past.places);
  const float8 tolerance = DEPTH_TOLERANCE * fabs(depth) + RANGE_TOLERANCE * range + LEAST_TOLERANCE;
  const float8 agreement = clamp(3.0f - 2.0f * fabs(before - depth) / tolerance, 0.0f, 1.0f);
  const float8 trust = agreement * whole * inside_previous(at_x, params->edge_x, (float)params->previous_width) *
                       inside_previous(at_y, params->edge_y, (float)params->previous_height);
  past.trust = as_float8(as_int8(trust) & known & ~non_finite_depths(before));
  return past;
}
