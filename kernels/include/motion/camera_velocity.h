// SPDX-License-Identifier: MIT
// The velocity that a moving camera gives still surfaces: near ones by depth, infinitely far ones by a model of the
// motion of its picture.
#pragma once

#include "bits.h"
#include "motion/velocity_params.h"

// Returns the velocity of four pixels of one row, uv, x and y in turn, jitter excluded. A surface that was not before
// the previous camera, or moved further than that, has +-65504.
static inline float8 velocity_of(float4 column, float ndc_y, float4 depth, const CameraVelocity* camera) {
  __private const float* m = camera->to_previous;
  const float4 ndc_x = column * camera->step_x + camera->start_x;
  const float4 x = m[0] * ndc_x + m[8] * depth + (m[4] * ndc_y + m[12]);
  const float4 y = m[1] * ndc_x + m[9] * depth + (m[5] * ndc_y + m[13]);
  const float4 w = m[3] * ndc_x + m[11] * depth + (m[7] * ndc_y + m[15]);
  const int4 before_camera = w > 0.0f;
  const float4 safe_w = select((float4)(1.0f), w, before_camera);
  const float4 velocity_x = clamp((ndc_x - x / safe_w) * 0.5f, -FINITE_HALF_MAX, FINITE_HALF_MAX);
  const float4 velocity_y = clamp((y / safe_w - ndc_y) * 0.5f, -FINITE_HALF_MAX, FINITE_HALF_MAX);
  const float4 seen_x = select((float4)(FINITE_HALF_MAX), velocity_x, before_camera);
  const float4 seen_y = select((float4)(FINITE_HALF_MAX), velocity_y, before_camera);
  return (float8)(seen_x.s0, seen_y.s0, seen_x.s1, seen_y.s1, seen_x.s2, seen_y.s2, seen_x.s3, seen_y.s3);
}

// The same of samples in lanes.
static inline LaneFloat2 velocities_of(LaneFloat column, float ndc_y, LaneFloat depth, const CameraVelocity* camera) {
#if LANES == 8
  const float8 left = velocity_of(column.lo, ndc_y, depth.lo, camera);
  const float8 right = velocity_of(column.hi, ndc_y, depth.hi, camera);
  const LaneFloat2 found = {(float8)(left.even, right.even), (float8)(left.odd, right.odd)};
#else
  const float8 one = velocity_of((float4)(column), ndc_y, (float4)(depth), camera);
  const LaneFloat2 found = {one.s0, one.s1};
#endif
  return found;
}

// The motion of what is infinitely far away, as a model of how a camera moves its picture. Places (x, y) and velocities
// are in heights of the picture, +y down, places from its middle. A still surface of reversed depth z moves by
//   (p0 + p1 x^2 + p3 x y - p4 y + p5 x + z (p6 + p8 x), p2 + p1 x y + p3 y^2 + p4 x + p5 y + z (p7 + p8 y))
// where the camera turns (p0 and p1, p2 and p3, p4 the roll), zooms (p5) and walks (p6 to p8), to the first order of a
// frame's motion: Longuet-Higgins and Prazdny, "The Interpretation of a Moving Retinal Image", 1980.

// Reversed depth: what lies beyond is not told from infinity. Files with linear depth have 1e10 where nothing was seen.
#define FARTHEST_DEPTH 1e-9f

// Terms of a surface's velocity: each parameter times its term is added to it.
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

// Returns the velocity of a sample that is infinitely far away.
static inline float2 far_velocity_at(const FarModel* motion, const FarPlaces* places, int x, int y) {
  const MotionTerms terms = motion_terms((float)x * places->step_x + places->start_x,
                                         (float)y * places->step_y + places->start_y, 0.0f);
  return modelled_velocity(motion, &terms);
}

// Whether a sample is infinitely far away and was drawn without motion.
static inline bool is_far_and_still(float depth, float2 drawn) {
  return fabs(depth) <= FARTHEST_DEPTH && drawn.x == 0.0f && drawn.y == 0.0f;
}
