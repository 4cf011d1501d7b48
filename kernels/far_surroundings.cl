// SPDX-License-Identifier: MIT
// far_surroundings: sums the drawn velocities of a cell of samples for a fit by least squares of the camera's motion,
// the model in motion/camera_velocity.h. A sample counts 1 / depth, since far samples show the camera's rotation more
// than its translation, and 1 / (1 + (r / .25)^2), where r is the error of the previous frame's fit at it in output
// pixels, so that moving objects drop out. Takes one of each 2x2 samples.
//   params    in   viewport, layouts, places
//   depth     in   R32F, viewport, reversed and infinite
//   drawn     in   RG16F or RG32F, viewport, in the caller's units
//   previous  in   FarModel of the frame before; all zero where there is none
//   sums      out  FarSums of each cell of kFarCell^2 samples
// A sample whose depth or velocity is not finite does not count, nor does one that far_velocity moves.
// Options: SOURCE_STORAGE (of depth and drawn), VELOCITY_FORMAT as in texel.h
// Reference: tests/reference/far_motion.cpp
#include "motion/camera_velocity.h"
#include "motion/velocity_params.h"
#include "texel.h"

#define NEAREST_TO_FAR 1e-6f  // reversed depth: what is farther counts no more than this
#define LARGE_RESIDUAL 0.25f  // output pixels
#define FASTEST 16.0f         // heights of the picture: what moves faster tells nothing

static inline float weight_of(const FarSumsParams* params, const FarModel* previous, const MotionTerms* terms,
                              float2 velocity, float z) {
  const float weight = 1.0f / max(fabs(z), NEAREST_TO_FAR);
  if (!previous->is_known) return weight;
  const float2 apart = (velocity - modelled_velocity(previous, terms)) * (params->pixels / LARGE_RESIDUAL);
  return weight / (1.0f + apart.x * apart.x + apart.y * apart.y);
}

static inline void add_sample(FarSums* sums, const MotionTerms* terms, float2 velocity, float weight) {
  int next = 0;
  for (int i = 0; i < kFarTerms; ++i) {
    const float x = weight * terms->x[i], y = weight * terms->y[i];
    for (int j = 0; j <= i; ++j) sums->products[next++] += x * terms->x[j] + y * terms->y[j];
    sums->velocities[i] += x * velocity.x + y * velocity.y;
  }
}

__kernel void far_surroundings(const FarSumsParams params, DEPTH_TEXELS depth, VELOCITY_TEXELS drawn,
                               __global const FarModel* previous, __global FarSums* sums) {
  const int cell_x = get_global_id(0), cell_y = get_global_id(1);
  if (cell_x >= params.cells_x || cell_y >= params.cells_y) return;

  const FarModel before = *previous;
  FarSums sum;
  for (int i = 0; i < kFarProducts; ++i) sum.products[i] = 0.0f;
  for (int i = 0; i < kFarTerms; ++i) sum.velocities[i] = 0.0f;
  const int end_x = min((cell_x + 1) * kFarCell, params.width), end_y = min((cell_y + 1) * kFarCell, params.height);
  for (int y = cell_y * kFarCell; y < end_y; y += 2) {
    for (int x = cell_x * kFarCell; x < end_x; x += 2) {
      const float z = load_depth4(depth, params.depth, (int4)(x), y).x;
      const float2 units = load_velocity4(drawn, params.drawn, (int4)(x), y).s01;
      const float2 velocity = units * (float2)(params.from_drawn_x, params.from_drawn_y);
      const bool tells = fabs(z) <= 1.0f && fabs(velocity.x) <= FASTEST && fabs(velocity.y) <= FASTEST;
      if (!tells || is_far_and_still(z, units)) continue;  // NaN tells nothing
      const MotionTerms terms = motion_terms((float)x * params.places.step_x + params.places.start_x,
                                             (float)y * params.places.step_y + params.places.start_y, z);
      add_sample(&sum, &terms, velocity, weight_of(&params, &before, &terms, velocity, z));
    }
  }
  sums[cell_y * params.cells_x + cell_x] = sum;
}
