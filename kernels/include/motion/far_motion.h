// SPDX-License-Identifier: MIT
// The motion of what is infinitely far away, as a model of how a camera moves its picture. Places (x, y) and velocities
// are in heights of the picture, +y down, places from its middle. A still surface of reversed depth z moves by
//   (p0 + p1 x^2 + p3 x y - p4 y + p5 x + z (p6 + p8 x), p2 + p1 x y + p3 y^2 + p4 x + p5 y + z (p7 + p8 y))
// where the camera turns (p0 and p1, p2 and p3, p4 the roll), zooms (p5) and walks (p6 to p8), to the first order of a
// frame's motion: Longuet-Higgins and Prazdny, "The Interpretation of a Moving Retinal Image", 1980.
#pragma once
#include "motion/far_params.h"

// Reversed depth: what lies beyond is not told from infinity. Files with linear depth have 1e10 where nothing was seen.
#define FARTHEST_DEPTH 1e-9f

// What each parameter adds to the velocity of a surface.
typedef struct MotionTerms {
  float x[kFarTerms], y[kFarTerms];
} MotionTerms;

static inline MotionTerms motion_terms(float x, float y, float z) {
  const MotionTerms terms = {{1.0f, x * x, 0.0f, x * y, -y, x, z, 0.0f, z * x},
                             {0.0f, x * y, 1.0f, y * y, x, y, 0.0f, z, z * y}};
  return terms;
}

static inline float2 modelled_velocity(const FarModel* motion, const MotionTerms* terms) {
  float2 velocity = (float2)(0.0f);
  for (int i = 0; i < kFarTerms; ++i) velocity += motion->p[i] * (float2)(terms->x[i], terms->y[i]);
  return velocity;
}

// Of what is infinitely far away at a sample.
static inline float2 far_velocity_at(const FarModel* motion, const FarPlaces* places, int x, int y) {
  const MotionTerms terms = motion_terms((float)x * places->step_x + places->start_x,
                                         (float)y * places->step_y + places->start_y, 0.0f);
  return modelled_velocity(motion, &terms);
}

// Whether a sample is infinitely far away and was drawn without motion.
static inline bool is_far_and_still(float depth, float2 drawn) {
  return fabs(depth) <= FARTHEST_DEPTH && drawn.x == 0.0f && drawn.y == 0.0f;
}
