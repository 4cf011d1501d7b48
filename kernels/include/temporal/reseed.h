// SPDX-License-Identifier: MIT
// Reseeding: history of almost no confidence starts over from this frame's samples around the pixel, those of the same
// surface. Samples of another one would stay behind as a ghost when it has moved on.
#pragma once

#include "arithmetic.h"
#include "bits.h"
#include "motion/motion_edge.h"
#include "temporal/accumulate.h"
#include "temporal/constants.h"
#include "temporal/fetch_history.h"
#include "temporal/frame_samples.h"
#include "temporal/limit_confidence.h"
#include "temporal/rectify.h"

// Where the samples' motion is read, and its scale to output pixels.
typedef struct SampleMotion {
  __global const float* reprojection;
  TexelLayout layout;
  float scale_x, scale_y;
} SampleMotion;

// The motions of the samples of row y nearest to eight pixels, x and y in turn; 0 where nothing moves.
static inline float16 motions_of(const SampleMotion* motion, int8 x, int y) {
#if MOTION
  __global const float* row = motion->reprojection + 4 * row_index(motion->layout, y);
  return (float16)(vload2(2 * x.s0, row), vload2(2 * x.s1, row), vload2(2 * x.s2, row), vload2(2 * x.s3, row),
                   vload2(2 * x.s4, row), vload2(2 * x.s5, row), vload2(2 * x.s6, row), vload2(2 * x.s7, row));
#else
  return (float16)(0.0f);
#endif
}

// How far samples of one motion may show the same surfaces as those of the other, by their motions: 1 to 0.
static inline float8 similarity(const SampleMotion* motion, float16 own, float16 other) {
#if MOTION
  const float16 apart = other - own;
  const float8 x = apart.even * motion->scale_x * (1.0f / SAME_SURFACE_MOTION_MAX);
  const float8 y = apart.odd * motion->scale_y * (1.0f / SAME_SURFACE_MOTION_MAX);
  return max(1.0f - x * x - y * y, SIMILARITY_MIN);
#else
  return (float8)(1.0f);
#endif
}

// Returns a substitute for a seed where none of the 3x3 samples is valid: the mean of the valid ones in eight
// directions, 2, 4, 8 and 16 samples away, weighted by 1 / distance. The substitute for infinity would not do: where
// history is resampled it would stay for several frames in the pixels around.
static inline float4 seed_from_afar(COLOUR_TEXELS texels, const SourceFrame* frame, int x, int y) {
  float4 sum = (float4)(0.0f);
  float weights = 0.0f;
  for (int distance = 2; distance <= SEED_DISTANCE_MAX; distance *= 2) {
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

// The seeds of eight pixels.
typedef struct EightSeeds {
  EightTexels mean;  // alpha in the last channel
  int8 known;        // lanes with a valid sample; of the others the mean is what stands in for the seed
} EightSeeds;

static inline void add_to_seeds(EightTexels* sum, float8* weights, EightTexels samples, float8 weight) {
  if (may_be_bright(samples)) weigh_by_luma(&samples, &weight, 0);
  sum->left += samples.left * to_four_texels(weight.lo);
  sum->right += samples.right * to_four_texels(weight.hi);
  *weights += weight;
}

// Replaces the means of the pixels without a valid sample near. The slow path.
static inline EightTexels seeds_from_afar(COLOUR_TEXELS texels, const SourceFrame* frame, EightTexels means,
                                          int8 known, int8 x, int y) {
  for (int i = 0; i < kLanes; ++i) {
    means = push_texel(means, known.s0 == 0 ? seed_from_afar(texels, frame, x.s0, y) : first_texel(means));
    known = NEXT_LANES(known);
    x = NEXT_LANES(x);
  }
  return means;
}

// The means of the 3x3 samples around the nearest ones, each weighted by a Gaussian of its distance, its luma weight
// and its similarity to the nearest.
static inline EightSeeds seeds_of(COLOUR_TEXELS texels, const SourceFrame* frame, const SampleMotion* motion,
                                  const NearestSamples* nearest) {
  const float16 none = (float16)(0.0f);
  const float16 own = motions_of(motion, nearest->x, nearest->y);
  EightTexels sum = {none, none};
  float8 weights = (float8)(0.0f);
  UNROLL_LANE(3)
  for (int row = -1; row <= 1; ++row) {
    const int y = clamp(nearest->y + row, 0, frame->height - 1);
    const float away_y = (float)row - nearest->from_y;
    UNROLL_LANE(3)
    for (int column = -1; column <= 1; ++column) {
      const int8 x = clamp(nearest->x + column, (int8)(0), (int8)(frame->width - 1));
      const float8 away_x = (float)column - nearest->from_x;
      const float8 near = bell((away_x * away_x + away_y * away_y) * SEED_FALLOFF);
      const float8 alike = similarity(motion, own, motions_of(motion, x, y));
      add_to_seeds(&sum, &weights, load_samples(texels, frame->colour, x, y), near * alike);
    }
  }
  const int8 known = weights > 0.0f;
  const float8 divisor = select((float8)(1.0f), weights, known);
  const EightTexels mean = {sum.left / to_four_texels(divisor.lo), sum.right / to_four_texels(divisor.hi)};
  const EightSeeds seeds = {
      all_lanes(known) ? mean : seeds_from_afar(texels, frame, mean, known, nearest->x, nearest->y), known};
  return seeds;
}

// ---- Rectification and reseeding of eight output pixels of a row.

static inline bool needs_correction(const Evidence* evidence) {
  return any_lane((evidence->rejection > 0.0f) | (evidence->confidence < CONFIDENCE_MIN));
}

// Brings history into the range of the samples around it by its rejection, where it has any.
static inline void rectify_history(COLOUR_TEXELS colour, const SourceFrame* frame, const NearestSamples* nearest,
                                   EightTexels* history, float8* alpha, Evidence* evidence) {
  const EightBoxes boxes = boxes_around(colour, frame, nearest->x, nearest->y);
  const Rectified left = rectify4(history->left, evidence->rejection.lo, &boxes.left);
  const Rectified right = rectify4(history->right, evidence->rejection.hi, &boxes.right);
  history->left = left.history;
  history->right = right.history;
  evidence->confidence *= (float8)(left.part, right.part);
#if ALPHA
  *alpha = rectify_alphas(colour, frame, nearest->x, nearest->y, *alpha, evidence->rejection);
#endif
}

// Reseeds the history of `lanes`. Returns its inertia.
static inline float8 reseed_history(COLOUR_TEXELS colour, const SourceFrame* frame, const SampleMotion* motion,
                                    const NearestSamples* nearest, int8 lanes, EightTexels* history, float8* alpha,
                                    float8* confidence) {
  const EightSeeds seeds = seeds_of(colour, frame, motion, nearest);
  const float8 none = (float8)(0.0f);
  const float8 share = select(none, 1.0f - *confidence / CONFIDENCE_MIN, lanes);
  history->left += (seeds.mean.left - history->left) * to_four_texels(share.lo);
  history->right += (seeds.mean.right - history->right) * to_four_texels(share.hi);
#if ALPHA
  *alpha += (confidences(seeds.mean) - *alpha) * share;
#endif
  *confidence = select(*confidence, select(none, (float8)(CONFIDENCE_MIN), seeds.known), lanes);
  return SEED_INERTIA * share;
}

// Rectifies history where it is rejected, and reseeds that of `lanes` where its confidence is less than the least; with
// ALPHA its alpha, too. Returns its inertia: how much it resists this frame's sample, as a weight.
static inline float8 correct_history(COLOUR_TEXELS colour, const SourceFrame* frame, const SampleMotion* motion,
                                     const NearestSamples* nearest, int8 lanes, EightTexels* history, float8* alpha,
                                     Evidence* evidence) {
  if (any_lane(evidence->rejection > 0.0f)) rectify_history(colour, frame, nearest, history, alpha, evidence);
  const int8 unknown = lanes & (evidence->confidence < CONFIDENCE_MIN);
  if (!any_lane(unknown)) return (float8)(0.0f);
  return reseed_history(colour, frame, motion, nearest, unknown, history, alpha, &evidence->confidence);
}
