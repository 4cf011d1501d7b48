// SPDX-License-Identifier: MIT
// The motion edge at a sample, in this frame and the previous one, for reproject.
#pragma once

#include "motion/motion_edge.h"
#include "motion/reproject_params.h"
#include "texel_blocks.h"

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
    if (!any_lane((own ^ as_int8(left)) | (own ^ as_int8(same)) | (own ^ as_int8(right)))) continue;  // most often
    largest = larger_difference(params, largest, velocity, left);
    largest = larger_difference(params, largest, velocity, same);
    largest = larger_difference(params, largest, velocity, right);
  }
  return sqrt(min(largest, LARGEST_SQUARED_EDGE));
}

enum { kEdgesAhead = 32 };  // samples to prefetch

// That of the previous frame at four of its samples. What that frame took over from the one before it, and NaN, count
// as 0.
static inline float4 previous_motion_edges(const ReprojectParams* params, __global const float* reprojection, int4 x,
                                           int4 y) {
  const TexelLayout layout = params->previous_reprojection;
  const int4 at = 4 * (layout.offset + y * layout.pitch + x) + 3;
  WILL_READ(reprojection + at.s0 + 4 * kEdgesAhead);
  const float4 edges = (float4)(reprojection[at.s0], reprojection[at.s1], reprojection[at.s2], reprojection[at.s3]);
  return fmax(edges, (float4)(0.0f));
}
