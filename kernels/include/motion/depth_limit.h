// SPDX-License-Identifier: MIT
// How near a surface may have been in the previous frame, and the depths that were there: what tells a surface that was
// seen from one that something hid. Depths are reversed, near / distance.
#pragma once

#include "motion/reproject_params.h"
#include "texel_blocks.h"

// What counts as in front, found by search on the development scenes.
#define DEPTH_TOLERANCE 1.02f     // ratio of reversed depths
#define SLOPE_TOLERANCE 2.0f      // steps of depth from a sample to the next
#define LEAST_APPROACH 0.25f      // of the distances before and after the camera's step

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
