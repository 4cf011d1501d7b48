// SPDX-License-Identifier: MIT
// For resolve_checkerboard: which surfaces four pixels that are not shaded may show, and where those were in the
// previous frame. The four lie two apart in one row; their neighbours are shaded.
#pragma once

#include "checkerboard/checkerboard_params.h"
#include "motion/camera_velocity.h"
#include "texel_blocks.h"

// What previous depth is the surface's, found on the bench's scenes.
#define DEPTH_TOLERANCE 0.02f      // of the surface's reversed depth
#define RANGE_TOLERANCE 0.5f       // of the difference of nearest and farthest neighbour
#define LEAST_TOLERANCE 1e-9f      // what is beyond is not told from infinity
#define FARTHEST_MOTION 65504.0f   // pixels of the previous frame: beyond any viewport

// A neighbour of each of four pixels.
typedef struct FourNeighbours {
  int4 x, y;
  float4 depth;     // 0 where it is not finite
  int4 is_inside;   // the viewport
  int4 is_surface;  // inside, and of finite depth
} FourNeighbours;

typedef struct FourSurfaces {
  FourNeighbours nearest, farthest;
  FourNeighbours likely;  // to be shown, as far as depth alone tells
  float4 range;           // of depth, from the farthest to the nearest
} FourSurfaces;

// The depths of four texels of a row, two apart, the first at column x.
static inline float4 load_every_other_depth(DEPTH_TEXELS texels, TexelLayout layout, int4 x, int y, int width) {
#if SOURCE_STORAGE == BUFFER
  if (x.s0 >= 0 && x.s0 + 7 < width) return vload8(0, texels + texel_index(layout, x.s0, y)).even;
#endif
  return load_depth4(texels, layout, clamp(x, (int4)(0), (int4)(width - 1)), y);
}

static inline FourNeighbours neighbours_at(const CheckerboardParams* params, DEPTH_TEXELS depth, int4 x, int y) {
  FourNeighbours found;
  found.is_inside = (x >= 0) & (x < params->width) & (int4)(y >= 0 && y < params->height ? -1 : 0);
  found.x = clamp(x, (int4)(0), (int4)(params->width - 1));
  const int row = clamp(y, 0, params->height - 1);
  found.y = row;
  const float4 held = load_every_other_depth(depth, params->shaded.depth, x, row, params->width);
  found.is_surface = found.is_inside & ~non_finite_lanes(held);
  found.depth = as_float4(as_int4(held) & found.is_surface);
  return found;
}

static inline FourNeighbours select_neighbours(FourNeighbours a, FourNeighbours b, int4 take_b) {
  const FourNeighbours taken = {select(a.x, b.x, take_b), select(a.y, b.y, take_b), select(a.depth, b.depth, take_b),
                                select(a.is_inside, b.is_inside, take_b), select(a.is_surface, b.is_surface, take_b)};
  return taken;
}

// The first where they are equal; one that is inside before one that is not.
static inline FourNeighbours nearer_of(FourNeighbours a, FourNeighbours b) {
  const int4 is_nearer = b.is_surface & (~a.is_surface | (b.depth > a.depth));
  return select_neighbours(a, b, (b.is_inside & ~a.is_inside) | is_nearer);
}

static inline FourNeighbours farther_of(FourNeighbours a, FourNeighbours b) {
  const int4 is_farther = b.is_surface & (~a.is_surface | (b.depth < a.depth));
  return select_neighbours(a, b, (b.is_inside & ~a.is_inside) | is_farther);
}

static inline FourSurfaces surfaces_around(const CheckerboardParams* params, DEPTH_TEXELS depth, int4 x, int y) {
  const FourNeighbours left = neighbours_at(params, depth, x - 1, y);
  const FourNeighbours right = neighbours_at(params, depth, x + 1, y);
  const FourNeighbours above = neighbours_at(params, depth, x, y - 1);
  const FourNeighbours below = neighbours_at(params, depth, x, y + 1);
  const FourNeighbours across = nearer_of(left, right), down = nearer_of(above, below);
  FourSurfaces around;
  around.nearest = nearer_of(across, down);
  around.farthest = farther_of(farther_of(left, right), farther_of(above, below));
  around.range = around.nearest.depth - around.farthest.depth;
  const int4 pair_across = left.is_surface & right.is_surface, pair_down = above.is_surface & below.is_surface;
  const int4 closer = fabs(left.depth - right.depth) <= fabs(above.depth - below.depth);
  around.likely = select_neighbours(around.nearest, down, pair_down);
  around.likely = select_neighbours(around.likely, across, pair_across & (~pair_down | closer));
  return around;
}

// 1 - the largest reactive value of the neighbours.
static inline float4 trust_in_reactive(const CheckerboardParams* params, REACTIVE_TEXELS reactive, int4 x, int y) {
#if REACTIVE
  const int4 last = params->width - 1;
  const int4 inside = min(x, last);
  const int4 left = select(inside - 1, inside + 1, inside == 0), right = select(inside + 1, inside - 1, inside == last);
  float4 largest = (float4)(0.0f);
  if (params->width > 1) {
    largest = max(load_reactive4(reactive, params->shaded.reactive, left, y),
                  load_reactive4(reactive, params->shaded.reactive, right, y));
  }
  if (y > 0) largest = max(largest, load_reactive4(reactive, params->shaded.reactive, inside, y - 1));
  if (y + 1 < params->height) largest = max(largest, load_reactive4(reactive, params->shaded.reactive, inside, y + 1));
  return 1.0f - largest;
#else
  return (float4)(1.0f);
#endif
}

// Where what four pixels may show was in the previous frame, as texel coordinates, and how far that is to be trusted.
typedef struct FourPasts {
  float4 x, y, trust;
} FourPasts;

// Velocity in its own units, x and y in turn.
static inline float8 surface_velocity(const CheckerboardParams* params, VELOCITY_TEXELS velocity,
                                      FourNeighbours surface, int4 x, int y) {
#if MOTION == TARGET
  return load_velocity_at(velocity, params->shaded.velocity, surface.x, surface.y);
#elif MOTION == CAMERA
  const float ndc_y = (float)y * params->camera.step_y + params->camera.start_y;
  return velocity_of(convert_float4(x), ndc_y, surface.depth, &params->camera);
#else
  return (float8)(0.0f);
#endif
}

// 1 inside [low, low + length], 0 from a pixel away on.
static inline float4 inside_previous(float4 at, float low, float length) {
  return clamp(1.0f - max(low - at, at - (low + length)), 0.0f, 1.0f);
}

// On one axis, the samples on both sides of a place, clamped to the edge; one and the same where the place is a sample.
typedef struct FourBetween {
  int4 low, high;
  float4 fraction;
} FourBetween;

static inline FourBetween between_samples(float4 at, int size) {
  const float4 whole = floor(at);
  FourBetween between;
  between.fraction = at - whole;
  const int4 low = convert_int4(whole);
  between.low = clamp(low, (int4)(0), (int4)(size - 1));
  between.high = clamp(low - (between.fraction > 0.0f), (int4)(0), (int4)(size - 1));
  return between;
}

static inline float4 mix_depths(float4 low, float4 high, float4 fraction) {
  return low + (high - low) * fraction;
}

// The previous depth at four places, linear between samples.
static inline float4 depth_between(const CheckerboardParams* params, DEPTH_TEXELS depth, FourBetween column,
                                   FourBetween row) {
  const TexelLayout layout = params->previous_depth;
  const int4 steps = (column.low - column.low.s0 - (int4)(0, 2, 4, 6)) | (row.low - row.low.s0) |
                     (column.high - column.high.s0 - (int4)(0, 2, 4, 6)) | (row.high - row.high.s0);
  const long2 uneven = as_long2(steps);
  float4 upper_left, upper_right, lower_left, lower_right;
  if ((uneven.x | uneven.y) == 0) {  // they move alike
    const int width = params->previous_width;
    upper_left = load_every_other_depth(depth, layout, column.low, row.low.s0, width);
    upper_right = load_every_other_depth(depth, layout, column.high, row.low.s0, width);
    lower_left = load_every_other_depth(depth, layout, column.low, row.high.s0, width);
    lower_right = load_every_other_depth(depth, layout, column.high, row.high.s0, width);
  } else {
    upper_left = load_depth_at(depth, layout, column.low, row.low);
    upper_right = load_depth_at(depth, layout, column.high, row.low);
    lower_left = load_depth_at(depth, layout, column.low, row.high);
    lower_right = load_depth_at(depth, layout, column.high, row.high);
  }
  return mix_depths(mix_depths(upper_left, upper_right, column.fraction),
                    mix_depths(lower_left, lower_right, column.fraction), row.fraction);
}

static inline FourPasts past_of(const CheckerboardParams* params, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth,
                                float4 range, FourNeighbours surface, int4 x, int y, float4 whole) {
  FourPasts past = {(float4)(0.0f), (float4)(0.0f), (float4)(0.0f)};
  if (!params->has_history) return past;
  const float8 moved = surface_velocity(params, velocity, surface, x, y);
  int4 lost = ~surface.is_surface | non_finite_lanes(moved.even) | non_finite_lanes(moved.odd);
  const float4 known_x = as_float4(as_int4(moved.even) & ~lost), known_y = as_float4(as_int4(moved.odd) & ~lost);
  past.x = convert_float4(x) * params->step_x + params->start_x +
           clamp(known_x * params->motion_x, -FARTHEST_MOTION, FARTHEST_MOTION);
  past.y = (float)y * params->step_y + params->start_y +
           clamp(known_y * params->motion_y, -FARTHEST_MOTION, FARTHEST_MOTION);
  const FourBetween column = between_samples(past.x, params->previous_width);
  const FourBetween row = between_samples(past.y, params->previous_height);
  const float4 before = depth_between(params, depth, column, row);
  lost |= non_finite_lanes(before);
  const float4 tolerance =
      DEPTH_TOLERANCE * fabs(surface.depth) + RANGE_TOLERANCE * range + LEAST_TOLERANCE;
  const float4 agreement = clamp(3.0f - 2.0f * fabs(before - surface.depth) / tolerance, 0.0f, 1.0f);
  const float4 trust = agreement * whole * inside_previous(past.x, params->edge_x, (float)params->previous_width) *
                       inside_previous(past.y, params->edge_y, (float)params->previous_height);
  past.trust = as_float4(as_int4(trust) & ~lost);
  return past;
}

// The neighbours whose surfaces the four pixels show.
static inline FourNeighbours shown_surfaces(const FourSurfaces* around, float4 near_trust, float4 far_trust) {
  const FourNeighbours hidden = select_neighbours(around->likely, around->farthest,
                                                  (1.0f - near_trust) * far_trust >= 0.5f);
  return select_neighbours(hidden, around->nearest, near_trust >= 0.5f);
}
