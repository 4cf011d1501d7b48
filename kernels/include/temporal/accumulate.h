// SPDX-License-Identifier: MIT
// Adding this frame's samples to history: the nearest one to each pixel.
#pragma once

#include "bits.h"
#include "temporal/constants.h"
#include "temporal/frame_samples.h"
#include "temporal/limit_confidence.h"

// Returns the reach of samples, output pixels, in a tile's pixels of such confidence.
static inline LaneFloat reach_of(TileReprojection tile, LaneFloat confidence) {
  if (stands_still(tile)) return max(SAMPLE_REACH - REACH_NARROWING * confidence, STILL_REACH_MIN);
  return (LaneFloat)(tile.is_rigid ? SAMPLE_REACH : WIDE_REACH);
}

// Returns (1 - d^2 / r^2)^2, d the distance in output pixels from each pixel's picture to its sample, r the reach.
static inline LaneFloat distance_weights(const TemporalParams* params, const NearestSamples* nearest, LaneFloat reach) {
  const LaneFloat away_x = nearest->from_x * params->spacing_x;
  const float away_y = nearest->from_y * params->spacing_y;
  const LaneFloat near = max(1.0f - (away_x * away_x + away_y * away_y) / (reach * reach), 0.0f);
  return near * near;
}

// Returns the luma weight of a sample, and holds it. An invalid one has none and becomes black.
static inline float luma_weight_or_none(float4* sample) {
  *sample = held_sample(*sample);
  if (is_valid(*sample)) return luma_weight(*sample);
  *sample = (float4)(0.0f);
  return 0.0f;
}

// Multiplies the weights of samples by their luma weights. Returns how many of the first `count` are not finite.
static inline uint weigh_by_luma(LaneTexels* samples, LaneFloat* weight, int count) {
  uint met = 0;
  UNROLL(8)
  for (int i = 0; i < kLanes; ++i) {
    float4 sample = first_texel(*samples);
    if (i < count && any_non_finite4(sample)) met += 1;
    FIRST_LANE(*weight) *= luma_weight_or_none(&sample);
    *weight = NEXT_LANES(*weight);
    *samples = push_texel(*samples, sample);
  }
  return met;
}

// Returns which samples are outliers, of those of pixels whose history is known.
static inline LaneMask are_held_back(LaneTexels history, LaneFloat confidence, LaneTexels samples) {
  const SampleLanes lanes = compare_lanes(samples);
  return (confidence >= CONFIDENCE_MIN) & are_outliers(&lanes, outlier_range(history));
}

// Returns how far each sample moves its pixel's history: weight / (confidence + weight), less by the inertia of
// reseeded ones.
static inline LaneFloat sample_parts(LaneFloat known, LaneFloat inertia, LaneFloat weight) {
  return weight / max(known + weight + inertia, WEIGHT_SUM_MIN);
}

// Returns the updated history.
static inline LaneTexels accumulate(LaneTexels history, LaneFloat known, LaneFloat inertia, LaneTexels samples,
                                    LaneFloat weight) {
  const LaneFloat part = sample_parts(known, inertia, weight);
  return with_last(move_to(history, samples, part), min(known + weight, CONFIDENCE_MAX));
}

// Returns the updated alpha.
static inline LaneFloat accumulate_alpha(LaneFloat history, LaneFloat known, LaneFloat inertia, LaneTexels samples,
                                         LaneFloat weight) {
  return history + (last_channels(samples) - history) * sample_parts(known, inertia, weight);
}
