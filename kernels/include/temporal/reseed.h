// SPDX-License-Identifier: MIT
// Reseeding: history of almost no confidence starts over from this frame's samples around the pixel, those of the same
// surface. Samples of another one would stay behind as a ghost when it has moved on.
#pragma once

#include "motion/motion_options.h"
#include "temporal/bell.h"
#include "temporal/frame_samples.h"

#define SEED_FALLOFF 2.5f    // 1 / (2 sigma^2), sigma .45 samples, as in the laboratory of docs/temporal.md
#define SAME_MOTION 0.15f    // output pixels a frame: surfaces whose motion differs by more are not the same. Ghosts
                             // fell from .17 to .06 at most, for -.01 dB (docs/temporal.md)
#define FARTHEST_SEED 16     // samples: a larger hole without any valid sample is black
#define LEAST_SIMILARITY 0x1p-10f  // not 0: the only valid sample counts whatever it shows

// Where the samples' motion is read, and its scale to output pixels.
typedef struct SampleMotion {
  __global const float* reprojection;
  TexelLayout layout;
  float scale_x, scale_y;
} SampleMotion;

// How far sample (other_x, other_y), clamped to the edge, may show the same surface as (x, y), by its motion: 1 to 0.
static inline float similarity(const SampleMotion* motion, const SourceFrame* frame, int x, int y, int other_x,
                               int other_y) {
#if MOTION
  const int column = clamp(other_x, 0, frame->width - 1), row = clamp(other_y, 0, frame->height - 1);
  const float2 own = vload2(2 * texel_index(motion->layout, x, y), motion->reprojection);
  const float2 other = vload2(2 * texel_index(motion->layout, column, row), motion->reprojection);
  const float2 apart = (other - own) * (float2)(motion->scale_x, motion->scale_y) * (1.0f / SAME_MOTION);
  return max(1.0f - apart.x * apart.x - apart.y * apart.y, LEAST_SIMILARITY);
#else
  return 1.0f;
#endif
}

// What stands in for a seed where none of the 3x3 samples is valid: the mean of the valid ones in eight directions, 2,
// 4, 8 and 16 samples away, weighted by 1 / distance. Not what stands in for infinity: where history is resampled it
// would stay for several frames in the pixels around.
static inline float4 seed_from_afar(COLOUR_TEXELS texels, const SourceFrame* frame, int x, int y) {
  float4 sum = (float4)(0.0f);
  float weights = 0.0f;
  for (int distance = 2; distance <= FARTHEST_SEED; distance *= 2) {
    for (int i = 0; i < 9; ++i) {
      const int column = x + (i % 3 - 1) * distance, row = y + (i / 3 - 1) * distance;
      const float4 sample = sample_at(texels, frame, column, row);
      if (!is_valid(sample)) continue;
      const float weight = luma_weight(sample) / (float)distance;
      sum += sample * weight;
      weights += weight;
    }
  }
  return weights > 0.0f ? sum / weights : sum;
}

typedef struct Seed {
  float4 mean;  // alpha in w
  bool any;     // whether any sample is valid; where none is, the mean is what stands in for the seed
} Seed;

// The seed of a pixel: the mean of the 3x3 samples around (x, y), the nearest one, each weighted by a Gaussian of its
// distance, its luma weight and its similarity to the nearest. The pixel's picture lies (from_x, from_y) samples from
// (x, y).
static inline Seed seed_of(COLOUR_TEXELS texels, const SourceFrame* frame, const SampleMotion* motion, int x, int y,
                           float from_x, float from_y) {
  float4 sum = (float4)(0.0f);
  float weights = 0.0f;
  for (int row = -1; row <= 1; ++row) {
    const float away_y = (float)row - from_y;
    for (int column = -1; column <= 1; ++column) {
      const float away_x = (float)column - from_x;
      const float4 sample = sample_at(texels, frame, x + column, y + row);
      const float near = bell((float8)((away_x * away_x + away_y * away_y) * SEED_FALLOFF)).s0;
      if (!is_valid(sample)) continue;
      const float weight = near * luma_weight(sample) * similarity(motion, frame, x, y, x + column, y + row);
      sum += sample * weight;
      weights += weight;
    }
  }
  const bool any = weights > 0.0f;
  const Seed seed = {any ? sum / weights : seed_from_afar(texels, frame, x, y), any};
  return seed;
}
