// SPDX-License-Identifier: MIT
// What a history begins with: the samples of one frame that show the same surface. Those of another would stay as a ghost when
// it has moved on.
#pragma once

#include "distance_weights.h"
#include "frame_samples.h"
#include "motion_options.h"

#define SMOOTH_FALLOFF 2.5f  // 1 / (2 sigma^2), sigma .45 samples
#define SAME_MOTION 0.15f    // output pixels a frame
#define LEAST_SIMILARITY 0x1p-10f

typedef struct Surfaces {
  __global const float* moves;
  TexelLayout layout;
  float scale_x, scale_y;
} Surfaces;

// How far sample (other_x, other_y) may show the same surface as (x, y), by its motion: 1 to 0.
static inline float similarity(const Surfaces* surfaces, const SourceFrame* frame, int x, int y, int other_x, int other_y) {
#if MOTION
  const int column = clamp(other_x, 0, frame->width - 1), row = clamp(other_y, 0, frame->height - 1);
  const float2 own = vload2(2 * texel_index(surfaces->layout, x, y), surfaces->moves);
  const float2 other = vload2(2 * texel_index(surfaces->layout, column, row), surfaces->moves);
  const float2 apart = (other - own) * (float2)(surfaces->scale_x, surfaces->scale_y) * (1.0f / SAME_MOTION);
  return max(1.0f - apart.x * apart.x - apart.y * apart.y, LEAST_SIMILARITY);
#else
  return 1.0f;
#endif
}

// The weighted mean of those of the 3x3 samples around (x, y) that move with it; (x, y) is the nearest to a place that lies
// (offset_x, offset_y) samples further. In w whether any sample is valid; where none is, the mean of what stands in for them.
static inline float4 smooth_samples(COLOUR_TEXELS texels, const SourceFrame* frame, const Surfaces* surfaces, int x, int y, float offset_x,
                                    float offset_y) {
  float4 sum = (float4)(0.0f), stand_in = (float4)(0.0f);
  float weights = 0.0f;
  for (int row = -1; row <= 1; ++row) {
    const float away_y = (float)row - offset_y;
    for (int column = -1; column <= 1; ++column) {
      const float away_x = (float)column - offset_x;
      const float4 sample = sample_at(texels, frame, x + column, y + row);
      const float near = bell((float8)((away_x * away_x + away_y * away_y) * SMOOTH_FALLOFF)).s0;
      if (is_valid(sample)) {
        const float weight = near * worth_of(sample) * similarity(surfaces, frame, x, y, x + column, y + row);
        sum += sample * weight;
        weights += weight;
      } else {
        stand_in += sanitise4(sample) * (1.0f / 9.0f);
      }
    }
  }
  const bool any = weights > 0.0f;
  const float4 mean = any ? sum / weights : stand_in;
  return (float4)(mean.xyz, any ? 1.0f : 0.0f);
}
