// SPDX-License-Identifier: MIT
// Seeds of a layer: what this frame's samples around one pixel show of it.
#pragma once

#include "layers/layer_taps.h"
#include "temporal/bell.h"
#include "temporal/reseed.h"

// This frame's samples, and which layer each is of.
typedef struct LayerSamples {
  SourceFrame frame;
  TexelLayout depth;
  float between;  // a depth between the layers
} LayerSamples;

// Of a pixel: its nearest sample (x, y), and where its picture lies from there, in samples.
typedef struct NearestSample {
  int x, y;
  float from_x, from_y;
} NearestSample;

// A sample of the near layer as that has it.
static inline float4 covered_sample(float4 sample) {
#if ALPHA
  return sample;
#else
  return (float4)(sample.xyz, 1.0f);
#endif
}

typedef struct Seed {
  float4 mean;  // alpha in w
  bool any;     // whether any sample is the layer's and valid; else the mean is 0
} Seed;

// The Gaussian of the 3x3 samples, clamped to the edge: of the far layer's, or of all valid ones as the near layer has
// them, in which one of the far layer's says that nothing of the near one is there.
static inline Seed seed_of_layer(const LayerSamples* in, COLOUR_TEXELS colour, DEPTH_TEXELS depth, LayerKind kind,
                                 NearestSample nearest) {
  float4 sum = (float4)(0.0f);
  float weights = 0.0f;
  for (int i = 0; i < 9; ++i) {
    const int column = i % 3 - 1, row = i / 3 - 1;
    const int x = clamp(nearest.x + column, 0, in->frame.width - 1);
    const int y = clamp(nearest.y + row, 0, in->frame.height - 1);
    float4 sample = load_colour(colour, in->frame.colour, x, y);
    const float own = load_depth(depth, in->depth, x, y);
    const bool is_near = own > in->between, is_far = own < in->between;
    if (!is_valid(sample) || !(is_far || (is_near && kind == kNearLayer))) continue;
    if (kind == kNearLayer) sample = is_near ? covered_sample(sample) : (float4)(0.0f);
    const float away_x = (float)column - nearest.from_x, away_y = (float)row - nearest.from_y;
    const float weight = bell((float8)((away_x * away_x + away_y * away_y) * SEED_FALLOFF)).s0 * luma_weight(sample);
    sum += sample * weight;
    weights += weight;
  }
  const Seed seed = {weights > 0.0f ? sum / weights : (float4)(0.0f), weights > 0.0f};
  return seed;
}
