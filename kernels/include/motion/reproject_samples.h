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

// The depths of four neighbours of a row, from x on, which may be -1. Beyond the edges they are mirrored, so that a
// slope has both sides.
static inline float4 load_depth_reflected(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width) {
#if SOURCE_STORAGE == BUFFER
  if (x >= 0 && x + 3 < width) return vload4(0, texels + texel_index(layout, x, y));
#endif
  const int4 column = x + (int4)(0, 1, 2, 3);
  const int4 reflected = min(max(column, -column), 2 * (width - 1) - column);
  return load_depth4(texels, layout, clamp(reflected, (int4)(0), (int4)(width - 1)), y);
}

// How far depth changes from one sample to the next: the gentler side of each axis.
static inline float4 slope_of(const ReprojectParams* params, DEPTH_TEXELS depth, int x, int y, float4 centre) {
  const int above = y > 0 ? y - 1 : min(1, params->height - 1);
  const int below = y + 1 < params->height ? y + 1 : max(y - 1, 0);
  const float4 left = load_depth_reflected(depth, params->depth0, x - 1, y, params->width);
  const float4 right = load_depth_reflected(depth, params->depth0, x + 1, y, params->width);
  const float4 upper = load_depth_block(depth, params->depth0, x, above, params->width);
  const float4 lower = load_depth_block(depth, params->depth0, x, below, params->width);
  return fmin(fabs(left - centre), fabs(right - centre)) + fmin(fabs(upper - centre), fabs(lower - centre));
}

// How many times nearer surfaces of these depths in columns x to x + 3 were if they stand still: 1 to 4.
static inline float4 nearer_before(const ReprojectParams* params, int x, int y, float4 depth) {
  const float4 columns = convert_float4(x + (int4)(0, 1, 2, 3));
  const float row = (float)y * params->distance_y + params->distance_start;
  return 1.0f / clamp(columns * params->distance_x + depth * params->distance_depth + row, LEAST_APPROACH, 1.0f);
}

static inline DepthRange previous_depths(const ReprojectParams* params, DEPTH_TEXELS depth, int4 x, int4 y) {
  if (params->previous_width > 1 && params->previous_height > 1)
    return depth_ranges(depth, params->depth1, x, y, params->previous_width);
  const int right = params->previous_width > 1 ? 1 : 0;
  const int below = params->previous_height > 1 ? 1 : 0;
  const float4 first = load_depth_at(depth, params->depth1, x, y);
  const float4 last = load_depth_at(depth, params->depth1, x + right, y + below);
  return range_of_rows(first, first, last, last);
}

// The largest depth that these samples' own surfaces may have had in the previous frame.
static inline float4 nearest_of_same(const ReprojectParams* params, DEPTH_TEXELS depth0, int x, int y, float4 depth) {
  const float4 tolerated = depth * DEPTH_TOLERANCE + slope_of(params, depth0, x, y, depth) * SLOPE_TOLERANCE;
  return tolerated * nearer_before(params, x, y, depth);
}

// ---- The motion edge at a sample, in this frame and the previous one.

#define LARGEST_SQUARED_EDGE 65504.0f  // output pixels, squared: two screens apart is no more of an edge than one

// The largest squared difference so far, or that of four velocities to their neighbours if it is larger; NaN does not
// count.
static inline float4 larger_difference(const ReprojectParams* params, float4 largest, float8 velocity,
                                       float8 neighbour) {
  const float4 x = (neighbour.even - velocity.even) * params->motion_edge_x;
  const float4 y = (neighbour.odd - velocity.odd) * params->motion_edge_y;
  const float4 difference = x * x + y * y;
  return select(largest, difference, difference > largest);
}

// The motion edge at each of the four samples from (x, y) on, whose velocities are given: the largest difference to the
// eight neighbours.
static inline float4 motion_edges_at(const ReprojectParams* params, VELOCITY_TEXELS texels, int x, int y,
                                     float8 velocity) {
  float4 largest = (float4)(0.0f);
  for (int row = max(y - 1, 0); row <= min(y + 1, params->height - 1); ++row) {
    const float8 left = load_velocity_block(texels, params->velocity0, x - 1, row, params->width);
    const float8 same = load_velocity_block(texels, params->velocity0, x, row, params->width);
    const float8 right = load_velocity_block(texels, params->velocity0, x + 1, row, params->width);
    const int8 own = as_int8(velocity);
    // Most often all are alike. One lane has three samples that nobody asks for; a test of them would make them count.
    if (LANES == 8 && !any_of_eight((own ^ as_int8(left)) | (own ^ as_int8(same)) | (own ^ as_int8(right)))) continue;
    largest = larger_difference(params, largest, velocity, left);
    largest = larger_difference(params, largest, velocity, same);
    largest = larger_difference(params, largest, velocity, right);
  }
  return sqrt(min(largest, LARGEST_SQUARED_EDGE));
}

enum { kEdgesAhead = 32 };  // samples to prefetch

// Returns the motion edges of the previous frame at four of its samples. An edge that it took over from the frame
// before it, or NaN, counts as 0.
static inline float4 previous_motion_edges(const ReprojectParams* params, __global const float* reprojection, int4 x,
                                           int4 y) {
  const TexelLayout layout = params->previous_reprojection;
  const int4 at = 4 * (layout.offset + y * layout.pitch + x) + 3;
  WILL_READ(reprojection + at.s0 + 4 * kEdgesAhead);
  const float4 edges = (float4)(reprojection[at.s0], reprojection[at.s1], reprojection[at.s2], reprojection[at.s3]);
  return fmax(edges, (float4)(0.0f));
}

// ---- Reactive values. With MOTION_EDGE, for an accumulated history: the largest of 3x3, since such
// a picture holds each sample further than its own pixel (+.35 dB on particles), and of 5x5 in the previous frame,
// whose pixels lie between other samples (the trail behind a transparent falls from 7/255 to 0). Without it the
// sample's own.

#if MOTION_EDGE
static inline float4 reactive_at(const ReprojectParams* params, REACTIVE_TEXELS texels, int x, int y) {
  float4 largest = (float4)(0.0f);
  for (int row = max(y - 1, 0); row <= min(y + 1, params->height - 1); ++row) {
    for (int column = x - 1; column <= x + 1; ++column)
      largest = max(largest, load_reactive_block(texels, params->reactive0, column, row, params->width));
  }
  return largest;
}

static inline float4 previous_reactive_at(const ReprojectParams* params, REACTIVE_TEXELS texels, int4 x, int4 y) {
  float4 largest = (float4)(0.0f);
  for (int i = 0; i < 25; ++i) {
    const int4 column = clamp(x + (i % 5 - 2), (int4)(0), (int4)(params->previous_width - 1));
    const int4 row = clamp(y + (i / 5 - 2), (int4)(0), (int4)(params->previous_height - 1));
    largest = max(largest, load_reactive_at(texels, params->reactive1, column, row));
  }
  return largest;
}
#else
static inline float4 reactive_at(const ReprojectParams* params, REACTIVE_TEXELS texels, int x, int y) {
  return load_reactive_block(texels, params->reactive0, x, y, params->width);
}

static inline float4 previous_reactive_at(const ReprojectParams* params, REACTIVE_TEXELS texels, int4 x, int4 y) {
  return load_reactive_at(texels, params->reactive1, x, y);
}
#endif
