// SPDX-License-Identifier: MIT
// For resolve_checkerboard: which surfaces pixels that are not shaded may show, where those were in the previous frame,
// and how far that is to be trusted. The pixels lie two apart in one row; their neighbours are shaded.
#pragma once

#include "bits.h"
#include "checkerboard/every_other.h"
#include "motion/camera_velocity.h"
#include "texels/surfaces.h"

// ---- Surfaces.

// Instead of the depth of a neighbour that is no surface: farther than all surfaces, those outside the viewport last.
#define NO_SURFACE -0x1p127f
#define OUTSIDE -INFINITY

// Whether all neighbours of the pixels from (x, y) on lie inside the viewport, with all between them.
static inline bool all_inside(const CheckerboardParams* params, int x, int y) {
  return run_is_inside(x - 1, params->width) && run_is_inside(x + 1, params->width) && y > 0 && y + 1 < params->height;
}

// Which do.
typedef struct InsideAround {
  LaneMask left, right, above, below;
} InsideAround;

static inline InsideAround inside_around(const CheckerboardParams* params, int x, int y) {
  const LaneInt column = every_other(x);
  const LaneMask is_column = column < params->width;
  const InsideAround inside = {(column > 0) & (column <= params->width), column + 1 < params->width,
                               is_column & mask_of(y > 0), is_column & mask_of(y + 1 < params->height)};
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
typedef LaneInt Sides;

static inline LaneMask are_second(Sides side) {
  return (side & 1) != 0;
}

static inline LaneMask are_down(Sides side) {
  return side >= 2;
}

typedef struct DepthsAround {
  LaneFloat left, right, above, below;
} DepthsAround;

static inline LaneFloat depth_on(Sides side, DepthsAround depths) {
  const LaneFloat across = select(depths.left, depths.right, are_second(side));
  const LaneFloat down = select(depths.above, depths.below, are_second(side));
  return select(across, down, are_down(side));
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
  LaneFloat nearest_depth;  // 0 where there is none
  LaneFloat farthest_depth;
  LaneMask is_surface;      // whether there is one at all
} Surfaces;

static inline LaneMask are_finite(LaneFloat values) {
  return (as_lane_int(values) & 0x7fffffff) < NON_FINITE_BITS;
}

static inline LaneFloat settled_depth(LaneFloat depth, LaneMask inside) {
  const LaneFloat none = select((LaneFloat)(OUTSIDE), (LaneFloat)(NO_SURFACE), inside);
  return select(none, depth, inside & are_finite(depth));
}

static inline DepthsAround settled_depths(const CheckerboardParams* params, DepthsAround depths, int x, int y) {
  const LaneMask finite =
      are_finite(depths.left) & are_finite(depths.right) & are_finite(depths.above) & are_finite(depths.below);
  if (all_inside(params, x, y) && all_lanes(finite)) return depths;
  const InsideAround inside = inside_around(params, x, y);
  const DepthsAround settled = {
      settled_depth(depths.left, inside.left), settled_depth(depths.right, inside.right),
      settled_depth(depths.above, inside.above), settled_depth(depths.below, inside.below)};
  return settled;
}

// Turns the depth of no surface into one as far in front, so that it is not the farthest.
static inline LaneFloat turned_over(LaneFloat settled) {
  return select(settled, -settled, settled <= NO_SURFACE);
}

// `second` where the mask says so, else `first`.
static inline Sides sides_of(int first, int second, LaneMask mask) {
  return select((Sides)(first), (Sides)(second), mask);
}

// Returns the nearest and the farthest of the surfaces around; the first of two that are equal counts.
static inline Surfaces surfaces_of(DepthsAround d) {
  const LaneFloat none = (LaneFloat)(0.0f);
  const LaneFloat across = max(d.left, d.right), down = max(d.above, d.below);
  Surfaces found;
  found.nearest = select(sides_of(0, 1, d.right > d.left), sides_of(2, 3, d.below > d.above), down > across);
  const LaneFloat nearest = max(across, down);
  found.is_surface = nearest > NO_SURFACE;
  found.nearest_depth = select(none, nearest, found.is_surface);

  const LaneFloat left = turned_over(d.left), right = turned_over(d.right);
  const LaneFloat above = turned_over(d.above), below = turned_over(d.below);
  const LaneFloat far_across = min(left, right), far_down = min(above, below);
  found.farthest = select(sides_of(0, 1, right < left), sides_of(2, 3, below < above), far_down < far_across);
  found.farthest_depth = select(none, min(far_across, far_down), found.is_surface);
  return found;
}

// Which surface a pixel shows as far as depth alone tells: the nearer one of the pair whose depths are closer.
static inline Sides likely_sides(DepthsAround d, Sides nearest) {
  const LaneMask pair_across = min(d.left, d.right) > NO_SURFACE, pair_down = min(d.above, d.below) > NO_SURFACE;
  const LaneMask closer = fabs(d.left - d.right) <= fabs(d.above - d.below);
  const Sides likely = select(nearest, sides_of(2, 3, d.below > d.above), pair_down);
  return select(likely, sides_of(0, 1, d.right > d.left), pair_across & (mask_not(pair_down) | closer));
}

typedef struct ReactiveAround {
  LaneUint left, right, above, below;  // codes
} ReactiveAround;

static inline LaneUint reactive_on(Sides side, ReactiveAround reactive) {
  const LaneUint across = select(reactive.left, reactive.right, are_second(side));
  const LaneUint down = select(reactive.above, reactive.below, are_second(side));
  return select(across, down, are_down(side));
}

// 0 from outside the viewport.
static inline ReactiveAround reactive_around(const CheckerboardParams* params, REACTIVE_TEXELS texels, int x, int y) {
  const InsideAround inside = inside_around(params, x, y);
  const TexelLayout layout = params->shaded.reactive;
  const int width = params->width;
  const LaneUint none = (LaneUint)(0);
  const ReactiveAround reactive = {
      select(none, load_every_other_reactive(texels, layout, x - 1, y, width), inside.left),
      select(none, load_every_other_reactive(texels, layout, x + 1, y, width), inside.right),
      select(none, load_every_other_reactive(texels, layout, x, row_above(y), width), inside.above),
      select(none, load_every_other_reactive(texels, layout, x, row_below(params, y), width), inside.below)};
  return reactive;
}

// 1 - the largest of the neighbours, and 0 exactly where that is 1.
static inline LaneFloat trust_in(ReactiveAround reactive) {
  const LaneUint largest = max(max(reactive.left, reactive.right), max(reactive.above, reactive.below));
  const LaneFloat rest = to_lane_float(255u - largest);
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

static inline VelocityBits select_velocities(VelocityBits otherwise, VelocityBits chosen, LaneMask mask) {
#if LANES == 1
  return mask ? chosen : otherwise;
#elif SOURCE_STORAGE == BUFFER && VELOCITY_FORMAT == HALF
  return select(otherwise, chosen, mask);
#else
  return select(otherwise, chosen, convert_long8(mask));
#endif
}

static inline VelocityBits velocity_on(Sides side, VelocitiesAround velocities) {
  const VelocityBits across = select_velocities(velocities.left, velocities.right, are_second(side));
  const VelocityBits down = select_velocities(velocities.above, velocities.below, are_second(side));
  return select_velocities(across, down, are_down(side));
}

typedef LaneFloat2 Motion;  // in velocity's own units

static inline Motion motion_of(VelocityBits bits) {
#if SOURCE_STORAGE == BUFFER && VELOCITY_FORMAT == HALF
  __private const half* halves = (__private const half*)&bits;
#if LANES == 8
  const float16 both = (float16)(vload_half8(0, halves), vload_half8(1, halves));
#else
  const float2 both = vload_half2(0, halves);
#endif
#elif LANES == 8
  const float16 both = as_float16(bits);
#else
  const float2 both = as_float2(bits);
#endif
  const Motion motion = {both.even, both.odd};
  return motion;
}

static inline Motion no_motion() {
  const Motion motion = {(LaneFloat)(0.0f), (LaneFloat)(0.0f)};
  return motion;
}

static inline Motion camera_motion(const CheckerboardParams* params, int x, int y, LaneFloat depth) {
  const float ndc_y = (float)y * params->camera.step_y + params->camera.start_y;
  return velocities_of(to_lane_float(every_other(x)), ndc_y, depth, &params->camera);
}

// On one axis: texels on both sides of a place, and how far it is from the lower one to the next. Not clamped.
typedef struct Between {
  LaneInt low;
  LaneFloat fraction;
} Between;

static inline Between between_texels(LaneFloat at) {
  const LaneInt low = floor_lanes(at);
  const Between between = {low, at - to_lane_float(low)};
  return between;
}

// The texels to read on both sides, clamped to the edge; one and the same where the place is a texel's own.
static inline LaneInt lower_texel(Between between, int size) {
  return clamp(between.low, (LaneInt)(0), (LaneInt)(size - 1));
}

static inline LaneInt upper_texel(Between between, int size) {
  const LaneInt upper = select(between.low, between.low + 1, between.fraction > 0.0f);
  return clamp(upper, (LaneInt)(0), (LaneInt)(size - 1));
}

// Where pixels were in the previous frame.
typedef struct Places {
  Between column, row;
  bool are_a_run;  // their texels on both sides are those of a run of sixteen in each of two rows
} Places;

static inline Places places_at(const CheckerboardParams* params, LaneFloat x, LaneFloat y) {
  Places places = {between_texels(x), between_texels(y), false};
#if LANES == 8
  const int8 apart = (places.column.low - every_other(places.column.low.s0)) | (places.row.low - places.row.low.s0);
  places.are_a_run = !any_of_eight(apart) && run_is_inside(places.column.low.s0, params->previous_width);
#endif
  return places;
}

// The two rows of a run.
static inline int upper_row(const CheckerboardParams* params, Places places) {
  return clamp(FIRST_LANE(places.row.low), 0, params->previous_height - 1);
}

static inline int lower_row(const CheckerboardParams* params, Places places) {
  return clamp(FIRST_LANE(places.row.low) + 1, 0, params->previous_height - 1);
}

static inline LaneFloat mix_depths(LaneFloat low, LaneFloat high, LaneFloat fraction) {
  return low + (high - low) * fraction;
}

// The previous depth at the places, linear between texels.
static inline LaneFloat depth_between(const CheckerboardParams* params, DEPTH_TEXELS depth, Places places) {
  const TexelLayout layout = params->previous_depth;
#if SOURCE_STORAGE == BUFFER && LANES == 8
  if (places.are_a_run) {
    const float16 upper = vload16(0, depth + texel_index(layout, places.column.low.s0, upper_row(params, places)));
    const float16 lower = vload16(0, depth + texel_index(layout, places.column.low.s0, lower_row(params, places)));
    const float8 held = mix_depths(mix_depths(upper.even, upper.odd, places.column.fraction),
                                   mix_depths(lower.even, lower.odd, places.column.fraction), places.row.fraction);
    if (all_lanes(are_finite(held))) return held;  // else a texel may count that has no part in it
  }
#endif
  const LaneInt left = lower_texel(places.column, params->previous_width);
  const LaneInt right = upper_texel(places.column, params->previous_width);
  const LaneInt above = lower_texel(places.row, params->previous_height);
  const LaneInt below = upper_texel(places.row, params->previous_height);
  return mix_depths(mix_depths(load_depths_at(depth, layout, left, above), load_depths_at(depth, layout, right, above),
                               places.column.fraction),
                    mix_depths(load_depths_at(depth, layout, left, below), load_depths_at(depth, layout, right, below),
                               places.column.fraction),
                    places.row.fraction);
}

// 1 inside [low, low + length], 0 from a pixel away on.
static inline LaneFloat inside_previous(LaneFloat at, float low, float length) {
  return clamp(1.0f - max(low - at, at - (low + length)), 0.0f, 1.0f);
}

typedef struct Past {
  Places places;
  LaneFloat trust;
} Past;

static inline Past no_past() {
  const Between nowhere = {(LaneInt)(0), (LaneFloat)(0.0f)};
  const Past past = {{nowhere, nowhere, false}, (LaneFloat)(0.0f)};
  return past;
}

// Returns the past of surfaces of these depths and motions; `whole`: trust where all agrees.
IN_REGISTERS static inline Past past_of(const CheckerboardParams* params, DEPTH_TEXELS previous, int x, int y,
                                        LaneFloat depth, Motion motion, LaneMask is_surface, LaneFloat range,
                                        LaneFloat whole) {
  const LaneFloat none = (LaneFloat)(0.0f);
  const LaneMask known = is_surface & are_finite(motion.x) & are_finite(motion.y);
  const LaneFloat moved_x = select(none, motion.x, known) * params->motion_x;
  const LaneFloat moved_y = select(none, motion.y, known) * params->motion_y;
  const LaneFloat at_x = to_lane_float(every_other(x)) * params->step_x + params->start_x +
                         clamp(moved_x, -FINITE_HALF_MAX, FINITE_HALF_MAX);
  const LaneFloat at_y =
      (float)y * params->step_y + params->start_y + clamp(moved_y, -FINITE_HALF_MAX, FINITE_HALF_MAX);
  Past past;
  past.places = places_at(params, at_x, at_y);
  const LaneFloat before = depth_between(params, previous, past.places);
  const LaneFloat tolerance = DEPTH_TOLERANCE * fabs(depth) + RANGE_TOLERANCE * range + LEAST_TOLERANCE;
  const LaneFloat agreement = clamp(3.0f - 2.0f * fabs(before - depth) / tolerance, 0.0f, 1.0f);
  const LaneFloat trust = agreement * whole * inside_previous(at_x, params->edge_x, (float)params->previous_width) *
                          inside_previous(at_y, params->edge_y, (float)params->previous_height);
  past.trust = select(none, trust, known & are_finite(before));
  return past;
}
