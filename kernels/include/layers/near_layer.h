// SPDX-License-Identifier: MIT
// The near layer of one pixel: history that follows the near surface, and this frame's sample added to it. A sample of
// the far surface says that nothing of the near one is there.
#pragma once

#include "layers/fetch_layers.h"
#include "temporal/accumulate.h"
#include "temporal/bell.h"
#include "temporal/correct_history.h"

#define MOST_NEAR_CONFIDENCE 8.0f  // it is resampled more often than not; 32 gives no more

// A near layer and its confidence.
typedef struct NearTexel {
  float4 value;  // premultiplied colour and coverage
  float confidence;
} NearTexel;

// Of a pixel: its nearest sample (x, y), and where its picture lies from there, in samples.
typedef struct NearPlace {
  int x, y;
  float from_x, from_y;
} NearPlace;

// This frame's samples, and which layer each is of.
typedef struct LayerSamples {
  SourceFrame frame;
  TexelLayout depth;
  float between;  // a depth between the layers
} LayerSamples;

// Of sample (x, y), clamped to the edge: 1 of the near layer, -1 of the far one, 0 of neither. It must be valid.
static inline int layer_of(const LayerSamples* in, COLOUR_TEXELS colour, DEPTH_TEXELS depth, int x, int y,
                           float4* sample) {
  const int column = clamp(x, 0, in->frame.width - 1), row = clamp(y, 0, in->frame.height - 1);
  *sample = load_colour(colour, in->frame.colour, column, row);
  const float own = load_depth(depth, in->depth, column, row);
  if (!is_valid(*sample)) return 0;
  return (own > in->between) - (own < in->between);
}

// As the near layer has it: premultiplied colour and coverage.
static inline float4 near_sample(float4 sample, int layer) {
#if ALPHA
  return layer > 0 ? sample : (float4)(0.0f);
#else
  return layer > 0 ? (float4)(sample.xyz, 1.0f) : (float4)(0.0f);
#endif
}

// The Gaussian of the 3x3 samples: of the far layer's, or of all as the near layer has them. In `confidence` what it is
// worth; 0 if there is none.
static inline NearTexel seed_layer(const LayerSamples* in, COLOUR_TEXELS colour, DEPTH_TEXELS depth, bool far,
                                   NearPlace place) {
  float4 sum = (float4)(0.0f);
  float weights = 0.0f;
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      float4 sample;
      const int layer = layer_of(in, colour, depth, place.x + column, place.y + row, &sample);
      if (layer == 0 || (far && layer > 0)) continue;
      const float4 value = far ? sample : near_sample(sample, layer);
      const float away_x = (float)column - place.from_x, away_y = (float)row - place.from_y;
      const float weight = bell((float8)((away_x * away_x + away_y * away_y) * SEED_FALLOFF)).s0 * luma_weight(value);
      sum += value * weight;
      weights += weight;
    }
  }
  const NearTexel seed = {weights > 0.0f ? sum / weights : (float4)(0.0f), weights > 0.0f ? LEAST_CONFIDENCE : 0.0f};
  return seed;
}

// `known` of history: what was fetched, in this frame's light.
static inline NearTexel update_near(const LayerSamples* in, COLOUR_TEXELS colour, DEPTH_TEXELS depth,
                                    const TemporalParams* params, NearPlace place, NearTexel known) {
  float4 m = known.value;
  float w = known.confidence, inertia = 0.0f;
  if (w < LEAST_CONFIDENCE) {
    const NearTexel seed = seed_layer(in, colour, depth, false, place);
    const float share = 1.0f - w / LEAST_CONFIDENCE;
    m += (seed.value - m) * share;
    inertia = INERTIA * share;
    w = seed.confidence;
  }
  float4 sample;
  const int layer = layer_of(in, colour, depth, place.x, place.y, &sample);
  const float4 value = near_sample(sample, layer);
  const float away_x = place.from_x * params->spacing_x, away_y = place.from_y * params->spacing_y;
  const float close = max(1.0f - (away_x * away_x + away_y * away_y) / (REACH * REACH), 0.0f);
  const float weight = layer != 0 ? close * close * luma_weight(value) : 0.0f;
  const float total = w + weight;
  m += (value - m) * (weight / max(total + inertia, LEAST_WEIGHT));
  const NearTexel updated = {m, min(total, MOST_NEAR_CONFIDENCE)};
  return updated;
}
