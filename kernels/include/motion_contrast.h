// SPDX-License-Identifier: MIT
// Edges of motion: how much the velocities of neighbours differ.
#pragma once

#include "texel_blocks.h"

#define LARGEST_MOVE 65504.0f  // pixels: beyond any viewport
#define EDGE_BEGINS 0.15f      // output pixels
#define EDGE_ENDS 0.6f
#define EDGE_COSTS_FROM 0.1f   // output pixels, too: where an edge begins to cost history
#define EDGE_COSTS_ALL 1.0f

static inline float8 smooth_step(float8 x, float low, float high) {
  const float8 t = clamp((x - low) * (1.0f / (high - low)), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

// How much an edge of motion makes history doubtful.
static inline float8 edge_strength(float8 contrast) {
  return smooth_step(contrast, EDGE_BEGINS, EDGE_ENDS);
}

// The largest squared distance so far, or that of four velocities to their neighbours if it is larger; a NaN does not count.
static inline float4 larger_distance(const ReprojectParams* params, float4 largest, float8 velocity, float8 neighbour) {
  const float4 x = (neighbour.even - velocity.even) * params->contrast_x;
  const float4 y = (neighbour.odd - velocity.odd) * params->contrast_y;
  return fmax(largest, x * x + y * y);
}

static inline float4 contrast_of(const ReprojectParams* params, VELOCITY_TEXELS texels, int x, int y, float8 velocity) {
  float4 largest = (float4)(0.0f);
  for (int row = max(y - 1, 0); row <= min(y + 1, params->height - 1); ++row) {
    const float8 left = load_velocity_block(texels, params->velocity0, x - 1, row, params->width);
    const float8 same = load_velocity_block(texels, params->velocity0, x, row, params->width);
    const float8 right = load_velocity_block(texels, params->velocity0, x + 1, row, params->width);
    largest = larger_distance(params, largest, velocity, left);
    largest = larger_distance(params, largest, velocity, same);
    largest = larger_distance(params, largest, velocity, right);
  }
  return sqrt(min(largest, LARGEST_MOVE));
}

static inline float4 contrast_before(const ReprojectParams* params, __global const float* moves, int4 x, int4 y) {
  const int4 at = 4 * (params->moves.offset + y * params->moves.pitch + x) + 3;
  return fmax((float4)(moves[at.s0], moves[at.s1], moves[at.s2], moves[at.s3]), (float4)(0.0f));
}

// How much of an edge of motion there was at four samples of the previous frame: 0 to 1.
static inline float4 edge_before(const ReprojectParams* params, __global const float* moves, int4 x, int4 y) {
  const float4 contrast = contrast_before(params, moves, x, y);
  return edge_strength((float8)(contrast, contrast)).lo;
}
