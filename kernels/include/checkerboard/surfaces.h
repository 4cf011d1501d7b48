// SPDX-License-Identifier: MIT
// For resolve_checkerboard: which surfaces eight pixels that are not shaded may show. They lie two apart in one row;
// their neighbours are shaded.
#pragma once

#include "bits.h"
#include "checkerboard/every_other.h"

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
