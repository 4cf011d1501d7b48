// SPDX-License-Identifier: MIT
// Samples that reproject reads, here and at their places in the previous frame: depths, motion edges, reactive values.
#pragma once

#include "bits.h"
#include "motion/motion_edge.h"
#include "motion/velocity_params.h"
#include "texels/surfaces.h"

// ---- Depths, reversed: near / distance. They tell a surface that was seen from one that something hid.

// Limits of what counts as in front, found by search on the development scenes.
#define DEPTH_TOLERANCE 1.02f     // ratio of reversed depths
#define SLOPE_TOLERANCE 2.0f      // steps of depth from a sample to the next
#define LEAST_APPROACH 0.25f      // smallest ratio of the distances before and after the camera's step

// The depths of neighbours of a row, from x on, which may be -1. Beyond the edges they are mirrored, so that a slope
// has both sides.
static inline LaneFloat load_depth_reflected(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width) {
  if (x >= 0 && x + kLanes <= width) return load_depth_row(texels, layout, x, y, width);
  const LaneInt column = x + LANE_NUMBERS;
  const LaneInt reflected = min(max(column, -column), 2 * (width - 1) - column);
  return load_depth_lanes(texels, layout, clamp(reflected, (LaneInt)(0), (LaneInt)(width - 1)), y);
}

// How far depth changes from one sample to the next: the gentler side of each axis.
static inline LaneFloat slope_of(const ReprojectParams* params, DEPTH_TEXELS depth, int x, int y, LaneFloat centre) {
  const int above = y > 0 ? y - 1 : min(1, params->height - 1);
  const int below = y + 1 < params->height ? y + 1 : max(y - 1, 0);
  const LaneFloat left = load_depth_reflected(depth, params->depth0, x - 1, y, params->width);
  const LaneFloat right = load_depth_reflected(depth, params->depth0, x + 1, y, params->width);
  const LaneFloat upper = load_depth_row(depth, params->depth0, x, above, params->width);
  const LaneFloat lower = load_depth_row(depth, params->depth0, x, below, params->width);
  return fmin(fabs(left - centre), fabs(right - centre)) + fmin(fabs(upper - centre), fabs(lower - centre));
}

// How many times nearer surfaces of these depths, from column x on, were if they stand still: 1 to 4.
static inline LaneFloat nearer_before(const ReprojectParams* params, int x, int y, LaneFloat depth) {
  const LaneFloat columns = to_lane_float(x + LANE_NUMBERS);
  const float row = (float)y * params->distance_y + params->distance_start;
  return 1.0f / clamp(columns * params->distance_x + depth * params->distance_depth + row, LEAST_APPROACH, 1.0f);
}

static inline DepthRanges previous_depths(const ReprojectParams* params, DEPTH_TEXELS depth, LaneInt x, LaneInt y) {
  if (params->previous_width > 1 && params->previous_height > 1)
    return depth_ranges(depth, params->depth1, x, y, params->previous_width);
  const int right = params->previous_width > 1 ? 1 : 0;
  const int below = params->previous_height > 1 ? 1 : 0;
  const LaneFloat first = load_depths_at(depth, params->depth1, x, y);
  const LaneFloat last = load_depths_at(depth, params->depth1, x + right, y + below);
  return ranges_of_rows(first, first, last, last);
}

// The largest depth that these samples' own surfaces may have had in the previous frame.
static inline LaneFloat nearest_of_same(const ReprojectParams* params, DEPTH_TEXELS depth0, int x, int y,
                                        LaneFloat depth) {
  const LaneFloat tolerated = depth * DEPTH_TOLERANCE + slope_of(params, depth0, x, y, depth) * SLOPE_TOLERANCE;
  return tolerated * nearer_before(params, x, y, depth);
}

// ---- The motion edge at a sample, in this frame and the previous one.

#define LARGEST_SQUARED_EDGE 65504.0f  // output pixels, squared: two screens apart is no more of an edge than one

// The largest squared difference so far, or that of velocities to their neighbours if it is larger; NaN does not count.
static inline LaneFloat larger_difference(const ReprojectParams* params, LaneFloat largest, LaneFloat2 velocity,
                                          LaneFloat2 neighbour) {
  const LaneFloat x = (neighbour.x - velocity.x) * params->motion_edge_x;
  const LaneFloat y = (neighbour.y - velocity.y) * params->motion_edge_y;
  const LaneFloat difference = x * x + y * y;
  return select(largest, difference, difference > largest);
}

// Whether the samples from (x, y) on all move as those around them do, to the bit; said of inner ones only.
static inline bool move_alike(const ReprojectParams* params, VELOCITY_TEXELS texels, int x, int y) {
#if LANES == 8 && SOURCE_STORAGE == BUFFER
  if (x < 1 || y < 1 || x + kLanes >= params->width || y + 1 >= params->height) return false;
  __global const uint* own = (__global const uint*)texels;
#if VELOCITY_FORMAT == HALF
  own += texel_index(params->velocity0, x, y);
  const uint8 bits = vload8(0, own);
  uint8 differing = (uint8)(0);
  for (int row = -1; row <= 1; ++row) {
    __global const uint* line = own + row * params->velocity0.pitch;
    differing |= (vload8(0, line - 1) ^ bits) | (vload8(0, line) ^ bits) | (vload8(0, line + 1) ^ bits);
  }
  return !any_of_eight(as_int8(differing));
#else
  own += 2 * texel_index(params->velocity0, x, y);
  const uint16 bits = vload16(0, own);
  uint16 differing = (uint16)(0);
  for (int row = -1; row <= 1; ++row) {
    __global const uint* line = own + 2 * row * params->velocity0.pitch;
    differing |= (vload16(0, line - 2) ^ bits) | (vload16(0, line) ^ bits) | (vload16(0, line + 2) ^ bits);
  }
  return !any_of_eight(as_int8(differing.lo | differing.hi));
#endif
#else
  return false;
#endif
}

// The motion edges at the samples from (x, y) on, whose velocities are given: the largest difference to the eight
// neighbours.
static inline LaneFloat motion_edges_at(const ReprojectParams* params, VELOCITY_TEXELS texels, int x, int y,
                                        LaneFloat2 velocity) {
  LaneFloat largest = (LaneFloat)(0.0f);
  if (move_alike(params, texels, x, y)) return largest;
  for (int row = max(y - 1, 0); row <= min(y + 1, params->height - 1); ++row) {
    for (int column = x - 1; column <= x + 1; ++column)
      largest = larger_difference(params, largest, velocity,
                                  load_velocity_row(texels, params->velocity0, column, row, params->width));
  }
  return sqrt(min(largest, LARGEST_SQUARED_EDGE));
}

enum { kEdgesAhead = 32 };  // samples to prefetch

// Returns motion edges of the previous frame at its samples (x, y). An edge that it took over from the frame before it,
// or NaN, counts as 0.
static inline LaneFloat previous_motion_edges(const ReprojectParams* params, __global const float* reprojection,
                                              LaneInt x, LaneInt y) {
  const TexelLayout layout = params->previous_reprojection;
  const LaneInt at = 4 * (layout.offset + y * layout.pitch + x) + 3;
  WILL_READ(reprojection + FIRST_LANE(at) + 4 * kEdgesAhead);
  WILL_READ(reprojection + FIRST_LANE(at) + 4 * (kEdgesAhead + 4));
  return fmax(gather(reprojection, at), (LaneFloat)(0.0f));
}

// ---- Reactive values. With MOTION_EDGE, for an accumulated history: the largest of 3x3, since such
// a picture holds each sample further than its own pixel (+.35 dB on particles), and of 5x5 in the previous frame,
// whose pixels lie between other samples (the trail behind a transparent falls from 7/255 to 0). Without it the
// sample's own.

#if MOTION_EDGE
// Whether no texel from `first` to `last` is reactive; said of up to sixteen columns and rows only.
static inline bool none_reactive(REACTIVE_TEXELS texels, TexelLayout layout, int width, int height, int2 first,
                                 int2 last) {
#if LANES == 8 && SOURCE_STORAGE == BUFFER
  const int left = clamp(first.x, 0, max(width - 16, 0)), right = min(last.x, width - 1);
  if (width < 16 || right >= left + 16 || last.y >= first.y + 16) return false;
  uchar16 any = (uchar16)(0);
  for (int row = max(first.y, 0); row <= min(last.y, height - 1); ++row)
    any |= vload16(0, texels + texel_index(layout, left, row));
  const ulong2 halves = as_ulong2(any);
  return (halves.x | halves.y) == 0;
#else
  return false;
#endif
}

static inline LaneFloat reactive_at(const ReprojectParams* params, REACTIVE_TEXELS texels, int x, int y) {
  LaneFloat largest = (LaneFloat)(0.0f);
  if (none_reactive(texels, params->reactive0, params->width, params->height, (int2)(x - 1, y - 1),
                    (int2)(x + kLanes, y + 1)))
    return largest;
  for (int row = max(y - 1, 0); row <= min(y + 1, params->height - 1); ++row) {
    for (int column = x - 1; column <= x + 1; ++column)
      largest = max(largest, load_reactive_row(texels, params->reactive0, column, row, params->width));
  }
  return largest;
}

static inline LaneFloat previous_reactive_at(const ReprojectParams* params, REACTIVE_TEXELS texels, LaneInt x,
                                             LaneInt y) {
  LaneFloat largest = (LaneFloat)(0.0f);
  const int2 first = (int2)(smallest_lane(x) - 2, smallest_lane(y) - 2);
  const int2 last = (int2)(largest_lane(x) + 2, largest_lane(y) + 2);
  if (none_reactive(texels, params->reactive1, params->previous_width, params->previous_height, first, last))
    return largest;
  for (int i = 0; i < 25; ++i) {
    const LaneInt column = clamp(x + (i % 5 - 2), (LaneInt)(0), (LaneInt)(params->previous_width - 1));
    const LaneInt row = clamp(y + (i / 5 - 2), (LaneInt)(0), (LaneInt)(params->previous_height - 1));
    largest = max(largest, load_reactives_at(texels, params->reactive1, column, row));
  }
  return largest;
}
#else
static inline LaneFloat reactive_at(const ReprojectParams* params, REACTIVE_TEXELS texels, int x, int y) {
  return load_reactive_row(texels, params->reactive0, x, y, params->width);
}

static inline LaneFloat previous_reactive_at(const ReprojectParams* params, REACTIVE_TEXELS texels, LaneInt x,
                                             LaneInt y) {
  return load_reactives_at(texels, params->reactive1, x, y);
}
#endif
