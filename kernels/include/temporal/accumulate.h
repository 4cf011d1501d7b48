// SPDX-License-Identifier: MIT
// Adding this frame's samples to history: the nearest one to each of eight pixels of a row.
#pragma once

#include "bits.h"
#include "temporal/constants.h"
#include "temporal/frame_samples.h"
#include "temporal/limit_confidence.h"

// Returns the reach of samples, output pixels, in a tile's pixels of such confidence.
static inline float8 reach_of(TileReprojection tile, float8 confidence) {
  if (stands_still(tile)) return max(SAMPLE_REACH - REACH_NARROWING * confidence, STILL_REACH_MIN);
  return (float8)(tile.is_rigid ? SAMPLE_REACH : WIDE_REACH);
}

// Returns (1 - d^2 / r^2)^2, d the distance in output pixels from each pixel's picture to its sample, r the reach.
static inline float8 distance_weights(const TemporalParams* params, const NearestSamples* nearest, float8 reach) {
  const float8 away_x = nearest->from_x * params->spacing_x;
  const float away_y = nearest->from_y * params->spacing_y;
  const float8 near = max(1.0f - (away_x * away_x + away_y * away_y) / (reach * reach), 0.0f);
  return near * near;
}

// Returns false only if none is brighter than 2 or invalid, so that their luma weights are all 1.
static inline bool may_be_bright(EightTexels samples) {
  const int16 bits = as_int16(samples.left) | as_int16(samples.right);
  const int8 half_bits = bits.lo | bits.hi;
  return any_at_least_two(ON_CPU ? half_bits.lo | half_bits.hi : as_int4(first_texel(samples)));
}

// Returns the luma weight of a sample. An invalid one has none and becomes black.
static inline float luma_weight_or_none(float4* sample) {
  if (is_valid(*sample)) return luma_weight(*sample);
  *sample = (float4)(0.0f);
  return 0.0f;
}

// Multiplies the weights of eight samples by their luma weights. Returns how many of the first `count` are not finite.
static inline uint weigh_by_luma(EightTexels* samples, float8* weight, int count) {
  uint met = 0;
  UNROLL(8)
  for (int i = 0; i < kLanes; ++i) {
    float4 sample = first_texel(*samples);
    if (i < count && any_non_finite4(sample)) met += 1;
    weight->s0 *= luma_weight_or_none(&sample);
    *weight = NEXT_LANES(*weight);
    *samples = push_texel(*samples, sample);
  }
  return met;
}

// Returns which samples are outliers, of those of pixels whose history is known.
static inline int8 are_held_back(EightTexels history, float8 confidence, EightTexels samples) {
  const SampleLanes lanes = compare_lanes(samples);
  return (confidence >= CONFIDENCE_MIN) & are_outliers(&lanes, outlier_range(history));
}

// Returns m + (s - m) part, and in w their confidence.
static inline float16 add_samples(float16 m, float16 s, float4 part, float4 confidence) {
  const float16 sum = m + (s - m) * to_four_texels(part);
  return select(sum, to_four_texels(confidence), LAST_CHANNELS);
}

// Returns how far each sample moves its pixel's history: weight / (confidence + weight), less by the inertia of
// reseeded ones.
static inline float8 sample_parts(float8 known, float8 inertia, float8 weight) {
  return weight / max(known + weight + inertia, WEIGHT_SUM_MIN);
}

// Returns the updated history.
static inline EightTexels accumulate(EightTexels history, float8 known, float8 inertia, EightTexels samples,
                                     float8 weight) {
  const float8 part = sample_parts(known, inertia, weight);
  const float8 confidence = min(known + weight, CONFIDENCE_MAX);
  const EightTexels sum = {add_samples(history.left, samples.left, part.lo, confidence.lo),
                           add_samples(history.right, samples.right, part.hi, confidence.hi)};
  return sum;
}

// Returns the updated alpha.
static inline float8 accumulate_alpha(float8 history, float8 known, float8 inertia, EightTexels samples,
                                      float8 weight) {
  return history + (last_channels(samples) - history) * sample_parts(known, inertia, weight);
}
