// SPDX-License-Identifier: MIT
// check_motion: predicts samples of this frame from the previous one, at the place that velocity gives and at those
// that it gives with x, y or both negated, and sums the four errors. Takes every kMotionStep-th sample of every
// kMotionStep-th row if all four places lie in the previous frame; it counts for each axis along which it moves by a
// sample or more. Both frames are softened, so that a place between samples is no smoother than one at a sample.
//   params      in      viewports, layouts, items, places
//   velocity    in      RG16F or RG32F, viewport, in the caller's units; NaN counts as 0, +-Inf as +-65504
//   colour0, 1  in      RGBA16F, RGBA32F or RGBA8, viewports of frames n and n-1
//   sums        in/out  MotionSums, to which each item adds
// Options: SOURCE_STORAGE, SOURCE_FORMAT, VELOCITY_FORMAT as in texel.h
// Reference: tests/reference/check_motion.cpp
#include "bits.h"
#include "picture_params.h"
#include "texel.h"

#define LEAST_SPEED 1.0f     // samples: what moves by less is nearly in the same place whatever the sign
#define MOST_CONTRAST 0.25f  // of both lights' sum: beyond it all forecasts are as wrong
#define LEAST_LIGHT 1e-30f  // two lights of 0 are alike

static inline float luma_at(COLOUR_TEXELS texels, TexelLayout layout, int x, int y) {
  const float4 colour = sanitise4(load_colour(texels, layout, x, y));
  return max(0.25f * (colour.x + 2.0f * colour.y + colour.z), 0.0f);
}

// A tent two samples wide to each side, at texel coordinates within the frame; at a sample it is 1 2 1 on each axis.
static inline float soft_luma(COLOUR_TEXELS texels, TexelLayout layout, int width, int height, float2 at) {
  const int left = (int)at.x, top = (int)at.y;
  float sum = 0.0f;
  for (int y = top - 1; y <= top + 2; ++y) {
    float row = 0.0f;
    for (int x = left - 1; x <= left + 2; ++x)
      row += (2.0f - min(fabs(at.x - (float)x), 2.0f)) *
             luma_at(texels, layout, clamp(x, 0, width - 1), clamp(y, 0, height - 1));
    sum += (2.0f - min(fabs(at.y - (float)y), 2.0f)) * row;
  }
  return sum * (1.0f / 16.0f);
}

// What the previous frame foretells at a place, in [0, 1]. Contrast, so that dark scenes tell as much as bright ones.
static inline float error_at(const MotionCheckParams* params, COLOUR_TEXELS colour1, float now, float2 at) {
  const float foretold = soft_luma(colour1, params->colour1, params->previous_width, params->previous_height, at);
  const float contrast = min(fabs(now - foretold) / (now + foretold + LEAST_LIGHT), MOST_CONTRAST);
  return contrast * contrast * (1.0f / (MOST_CONTRAST * MOST_CONTRAST));
}

static inline void add_axis(volatile __global MotionAxisSums* sums, uint samples, float4 errors) {
  if (samples == 0) return;
  const uint4 units = convert_uint4(errors * (float)kMotionUnits + 0.5f);
  atomic_add(&sums->samples, samples);
  atomic_add(&sums->errors[0], units.s0);
  atomic_add(&sums->errors[1], units.s1);
  atomic_add(&sums->errors[2], units.s2);
  atomic_add(&sums->errors[3], units.s3);
}

__kernel void check_motion(const MotionCheckParams params, VELOCITY_TEXELS velocity, COLOUR_TEXELS colour0,
                           COLOUR_TEXELS colour1, volatile __global MotionSums* sums) {
  const int item_x = get_global_id(0), item_y = get_global_id(1);
  if (item_x >= params.items_x || item_y >= params.items_y) return;

  const float2 last = (float2)((float)(params.previous_width - 1), (float)(params.previous_height - 1));
  float4 errors_x = 0.0f, errors_y = 0.0f;
  uint samples_x = 0, samples_y = 0;
  for (int j = 0; j < kMotionSamples; ++j) {
    const int y = (item_y * kMotionSamples + j) * kMotionStep + kMotionStep / 2;
    for (int i = 0; i < kMotionSamples; ++i) {
      const int x = (item_x * kMotionSamples + i) * kMotionStep + kMotionStep / 2;
      if (x >= params.width || y >= params.height) continue;
      const float2 units = load_velocity(velocity, params.velocity, x, y);
      const float2 moved =
          sanitise4((float4)(units.x * params.motion_x, units.y * params.motion_y, 0.0f, 0.0f)).xy;
      const float2 reach = fabs(moved);
      const bool moves_x = reach.x >= LEAST_SPEED, moves_y = reach.y >= LEAST_SPEED;
      if (!moves_x && !moves_y) continue;
      const float2 still = (float2)((float)x * params.step_x + params.start_x,
                                    (float)y * params.step_y + params.start_y);
      if (any(still - reach < (float2)(0.0f)) || any(still + reach > last)) continue;
      const float now = soft_luma(colour0, params.colour0, params.width, params.height, (float2)((float)x, (float)y));
      const float4 errors = (float4)(error_at(&params, colour1, now, still + moved),
                                     error_at(&params, colour1, now, still + (float2)(-moved.x, moved.y)),
                                     error_at(&params, colour1, now, still + (float2)(moved.x, -moved.y)),
                                     error_at(&params, colour1, now, still - moved));
      errors_x += moves_x ? errors : (float4)(0.0f);
      errors_y += moves_y ? errors : (float4)(0.0f);
      samples_x += moves_x ? 1 : 0;
      samples_y += moves_y ? 1 : 0;
    }
  }
  add_axis(&sums->x, samples_x, errors_x);
  add_axis(&sums->y, samples_y, errors_y);
}
