// SPDX-License-Identifier: MIT
// For resolve_checkerboard: which surfaces eight pixels that are not shaded may show, where those were in the previous
// frame, and how far that is to be trusted. The pixels lie two apart in one row; their neighbours are shaded.
#pragma once

#include "bits.h"
#include "checkerboard/every_other.h"
#include "motion/camera_velocity.h"
#include "texels/surfaces.h"

// ---- Surfaces.

// Instead of the depth of a neighbour that is no surface: farther than all surfaces, those outside the viewport last.
#define NO_SURFACE -0x1p127f
#define OUTSIDE -INFINITY

// Whether all neighbours of the eight pixels from (x, y) on lie inside the viewport, with all between them.
static inline bool all_inside(const CheckerboardParams* params, int x, int y) {
  return run_is_inside(x - 1, params->width) && run_is_inside(x + 1, params->width) && y > 0 && y + 1 < params->height;
}

// Which do: each lane 0 or -1.
typedef struct InsideAround {
  int8 left, right, above, below;
} InsideAround;

static inline InsideAround inside_around(const CheckerboardParams* params, int x, int y) {
  const int8 column = every_other(x);
  const int8 is_column = column < params->width;
  const InsideAround inside = {(column > 0) & (column <= params->width), column + 1 < params->width,
                               y > 0 ? is_column : (int8)(0), y + 1 < params->height ? is_column : (int8)(0)};
  return inside;
}

// The rows above and below, within the viewport.
static inline int row_above(int y) {
  return max(y - 1, 0);
}

static inline int row_below(const CheckerboardParams* params, int y) {
  return min(y + 1, params->height - 1);
}

// Which neighbour each pixel takes after: 0 left, 1 right, 2 above, 3 below.
typedef int8 Sides;

typedef struct DepthsAround {
  float8 left, right, above, below;
} DepthsAround;

static inline float8 depth_on(Sides side, DepthsAround depths) {
  const float8 across = select(depths.left, depths.right, side << 31);
  const float8 down = select(depths.above, depths.below, side << 31);
  return select(across, down, side << 30);
}

static inline DepthsAround depths_around(const CheckerboardParams* params, DEPTH_TEXELS depth, int x, int y) {
  const TexelLayout layout = params->shaded.depth;
  const DepthsAround depths = {
      load_every_other_depth(depth, layout, x - 1, y, params->width),
      load_every_other_depth(depth, layout, x + 1, y, params->width),
      load_every_other_depth(depth, layout, x, row_above(y), params->width),
      load_every_other_depth(depth, layout, x, row_below(params, y), params->width)};
  return depths;
}

typedef struct Surfaces {
  Sides nearest, farthest;
  float8 nearest_depth;  // 0 where there is none
  float8 farthest_depth;
  int8 is_surface;       // whether there is one at all: 0 or -1
} Surfaces;

static inline int8 non_finite_depths(float8 depth) {
  return (as_int8(depth) & 0x7fffffff) >= NON_FINITE_BITS;
}

static inline float8 settled_depth(float8 depth, int8 inside) {
  const float8 none = select((float8)(OUTSIDE), (float8)(NO_SURFACE), inside);
  return select(none, depth, inside & ~non_finite_depths(depth));
}

static inline DepthsAround settled_depths(const CheckerboardParams* params, DepthsAround depths, int x, int y) {
  const int8 lost = non_finite_depths(depths.left) | non_finite_depths(depths.right) |
                    non_finite_depths(depths.above) | non_finite_depths(depths.below);
  if (all_inside(params, x, y) && !any_of_eight(lost)) return depths;
  const InsideAround inside = inside_around(params, x, y);
  const DepthsAround settled = {
      settled_depth(depths.left, inside.left), settled_depth(depths.right, inside.right),
      settled_depth(depths.above, inside.above), settled_depth(depths.below, inside.below)};
  return settled;
}

// Turns the depth of no surface into one as far in front, so that it is not the farthest.
static inline float8 turned_over(float8 settled) {
  return select(settled, -settled, settled <= NO_SURFACE);
}

// Returns the nearest and the farthest of the surfaces around; the first of two that are equal counts.
static inline Surfaces surfaces_of(DepthsAround d) {
  const int8 right_is_nearer = d.right > d.left, below_is_nearer = d.below > d.above;
  const float8 across = max(d.left, d.right), down = max(d.above, d.below);
  const Sides nearer_across = right_is_nearer & 1, nearer_down = 2 - below_is_nearer;
  Surfaces found;
  found.nearest = select(nearer_across, nearer_down, down > across);
  const float8 nearest = max(across, down);
  found.is_surface = nearest > NO_SURFACE;
  found.nearest_depth = as_float8(as_int8(nearest) & found.is_surface);

  const float8 left = turned_over(d.left), right = turned_over(d.right);
  const float8 above = turned_over(d.above), below = turned_over(d.below);
  const float8 far_across = min(left, right), far_down = min(above, below);
  found.farthest = select((right < left) & 1, 2 - (below < above), far_down < far_across);
  found.farthest_depth = as_float8(as_int8(min(far_across, far_down)) & found.is_surface);
  return found;
}

// Which surface a pixel shows as far as depth alone tells: the nearer one of the pair whose depths are closer.
static inline Sides likely_sides(DepthsAround d, Sides nearest) {
  const int8 pair_across = min(d.left, d.right) > NO_SURFACE, pair_down = min(d.above, d.below) > NO_SURFACE;
  const int8 closer = fabs(d.left - d.right) <= fabs(d.above - d.below);
  const Sides likely = select(nearest, 2 - (d.below > d.above), pair_down);
  return select(likely, (d.right > d.left) & 1, pair_across & (~pair_down | closer));
}

typedef struct ReactiveAround {
  uint8 left, right, above, below;  // codes
} ReactiveAround;

static inline uint8 reactive_on(Sides side, ReactiveAround reactive) {
  const uint8 across = select(reactive.left, reactive.right, as_uint8(side << 31));
  const uint8 down = select(reactive.above, reactive.below, as_uint8(side << 31));
  return select(across, down, as_uint8(side << 30));
}

// 0 from outside the viewport.
static inline ReactiveAround reactive_around(const CheckerboardParams* params, REACTIVE_TEXELS texels, int x, int y) {
  const InsideAround inside = inside_around(params, x, y);
  const TexelLayout layout = params->shaded.reactive;
  const int width = params->width;
  const ReactiveAround reactive = {
      load_every_other_reactive(texels, layout, x - 1, y, width) & as_uint8(inside.left),
      load_every_other_reactive(texels, layout, x + 1, y, width) & as_uint8(inside.right),
      load_every_other_reactive(texels, layout, x, row_above(y), width) & as_uint8(inside.above),
      load_every_other_reactive(texels, layout, x, row_below(params, y), width) & as_uint8(inside.below)};
  return reactive;
}

// 1 - the largest of the neighbours, and 0 exactly where that is 1.
static inline float8 trust_in(ReactiveAround reactive) {
  const uint8 largest = max(max(reactive.left, reactive.right), max(reactive.above, reactive.below));
  const float8 rest = convert_float8(255u - largest);
  return FRACTION_OF_CODE(rest);
}

// ---- Where they were.

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
  if (LANES == 8 && places.are_a_run) {
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
