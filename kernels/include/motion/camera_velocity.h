// SPDX-License-Identifier: MIT
// The velocity that a moving camera gives what stands still.
#pragma once
#include "motion/velocity_params.h"

#define LARGEST_VELOCITY 65504.0f  // the largest half

// Velocity of four pixels of one row, uv, x and y in turn, jitter excluded. What was not before the previous camera, or
// moved further than that, has +-65504.
static inline float8 velocity_of(float4 column, float ndc_y, float4 depth, const CameraVelocity* camera) {
  __private const float* m = camera->to_previous;
  const float4 ndc_x = column * camera->step_x + camera->start_x;
  const float4 x = m[0] * ndc_x + m[8] * depth + (m[4] * ndc_y + m[12]);
  const float4 y = m[1] * ndc_x + m[9] * depth + (m[5] * ndc_y + m[13]);
  const float4 w = m[3] * ndc_x + m[11] * depth + (m[7] * ndc_y + m[15]);
  const int4 before_camera = w > 0.0f;
  const float4 safe_w = select((float4)(1.0f), w, before_camera);
  const float4 velocity_x = clamp((ndc_x - x / safe_w) * 0.5f, -LARGEST_VELOCITY, LARGEST_VELOCITY);
  const float4 velocity_y = clamp((y / safe_w - ndc_y) * 0.5f, -LARGEST_VELOCITY, LARGEST_VELOCITY);
  const float4 seen_x = select((float4)(LARGEST_VELOCITY), velocity_x, before_camera);
  const float4 seen_y = select((float4)(LARGEST_VELOCITY), velocity_y, before_camera);
  return (float8)(seen_x.s0, seen_y.s0, seen_x.s1, seen_y.s1, seen_x.s2, seen_y.s2, seen_x.s3, seen_y.s3);
}
