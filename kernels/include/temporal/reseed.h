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

// The motions of the samples of a row nearest to the pixels; 0 where nothing moves.
typedef struct Motions {
  LaneFloat x, y;
} Motions;

static inline Motions motions_of(const SampleMotion* motion, LaneInt x, int y) {
#if MOTION
  __global const float* row = motion->reprojection + 4 * row_index(motion->layout, y);
  const Motions motions = {gather(row, 4 * x), gather(row + 1, 4 * x)};
#else
  const Motions motions = {(LaneFloat)(0.0f), (LaneFloat)(0.0f)};
#endif
  return motions;
}

// How far samples of one motion may show the same surfaces as those of the other, by their motions: 1 to 0.
static inline LaneFloat similarity(const SampleMotion* motion, Motions own, Motions other) {
#if MOTION
  const LaneFloat x = (other.x - own.x) * motion->scale_x * (1.0f / SAME_SURFACE_MOTION_MAX);
  const LaneFloat y = (other.y - own.y) * motion->scale_y * (1.0f / SAME_SURFACE_MOTION_MAX);
  return max(1.0f - x * x - y * y, SIMILARITY_MIN);
#else
  return (LaneFloat)(1.0f);
#endif
}

// Returns a substitute for a seed where none of the 3x3 samples is valid: the mean of the valid ones in eight
// directions, 2, 4, 8 and 16 samples away, weighted by 1 / distance. The substitute for infinity would not do: where
// history is resampled it would stay for several frames in the pixels around.
static inline float4 seed_from_afar(COLOUR_TEXELS texels, const ExposedFrame* frame, int x, int y) {
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

// The seeds of pixels.
typedef struct Seeds {
  LaneTexels mean;  // alpha in the last channel
  LaneMask known;       // lanes with a valid sample; of the others the mean is what stands in for the seed
} Seeds;

static inline void add_to_seeds(LaneTexels* sum, LaneFloat* weights, LaneTexels samples, LaneFloat weight) {
  if (may_be_bright(samples)) weigh_by_luma(&samples, &weight, 0);
  *sum = add_times(*sum, samples, weight);
  *weights += weight;
}

// Replaces the means of the pixels without a valid sample near. The slow path.
static inline LaneTexels seeds_from_afar(COLOUR_TEXELS texels, const ExposedFrame* frame, LaneTexels means,
                                         LaneMask known, LaneInt x, int y) {
  for (int i = 0; i < kLanes; ++i) {
    const bool is_known = FIRST_LANE(known);
    means = push_texel(means, is_known ? first_texel(means) : seed_from_afar(texels, frame, FIRST_LANE(x), y));
    known = NEXT_LANES(known);
    x = NEXT_LANES(x);
  }
  return means;
}

// The means of the 3x3 samples around the nearest ones, each weighted by a Gaussian of its distance, its luma weight
// and its similarity to the nearest.
static inline Seeds seeds_of(COLOUR_TEXELS texels, const ExposedFrame* frame, const SampleMotion* motion,
                             const NearestSamples* nearest) {
  const Motions own = motions_of(motion, nearest->x, nearest->y);
  LaneTexels sum = no_texels();
  LaneFloat weights = (LaneFloat)(0.0f);
  UNROLL_LANE(3)
  for (int row = -1; row <= 1; ++row) {
    const int y = clamp(nearest->y + row, 0, frame->height - 1);
    const float away_y = (float)row - nearest->from_y;
    UNROLL_LANE(3)
    for (int column = -1; column <= 1; ++column) {
      const LaneInt x = clamp(nearest->x + column, (LaneInt)(0), (LaneInt)(frame->width - 1));
      const LaneFloat away_x = (float)column - nearest->from_x;
      const LaneFloat near = bell((away_x * away_x + away_y * away_y) * SEED_FALLOFF);
      const LaneFloat alike = similarity(motion, own, motions_of(motion, x, y));
      add_to_seeds(&sum, &weights, load_samples(texels, frame, x, y), near * alike);
    }
  }
  const LaneMask known = weights > 0.0f;
  const LaneFloat divisor = select((LaneFloat)(1.0f), weights, known);
  const LaneTexels mean = over(sum, divisor);
  const Seeds seeds = {
      all_lanes(known) ? mean : seeds_from_afar(texels, frame, mean, known, nearest->x, nearest->y), known};
  return seeds;
}

// ---- Rectification and reseeding of output pixels of a row.

static inline bool needs_correction(const Evidence* evidence) {
  return any_lane((evidence->rejection > 0.0f) | (evidence->confidence < CONFIDENCE_MIN));
}

// Brings history into the range of the samples around it by its rejection, where it has any.
static inline void rectify_history(COLOUR_TEXELS colour, const ExposedFrame* frame, const NearestSamples* nearest,
                                   LaneTexels* history, LaneFloat* alpha, Evidence* evidence) {
  const ToneBoxes boxes = boxes_around(colour, frame, nearest->x, nearest->y);
  const Rectified rectified = rectify_texels(*history, evidence->rejection, &boxes);
  *history = rectified.history;
  evidence->confidence *= rectified.part;
#if ALPHA
  *alpha = rectify_alphas(colour, frame, nearest->x, nearest->y, *alpha, evidence->rejection);
#endif
}

// Reseeds the history of `lanes`. Returns its inertia.
static inline LaneFloat reseed_history(COLOUR_TEXELS colour, const ExposedFrame* frame, const SampleMotion* motion,
                                       const NearestSamples* nearest, LaneMask lanes, LaneTexels* history,
                                       LaneFloat* alpha, LaneFloat* confidence) {
  const Seeds seeds = seeds_of(colour, frame, motion, nearest);
  const LaneFloat none = (LaneFloat)(0.0f);
  const LaneFloat share = select(none, 1.0f - *confidence / CONFIDENCE_MIN, lanes);
  *history = move_to(*history, seeds.mean, share);
#if ALPHA
  *alpha += (confidences(seeds.mean) - *alpha) * share;
#endif
  *confidence = select(*confidence, select(none, (LaneFloat)(CONFIDENCE_MIN), seeds.known), lanes);
  return SEED_INERTIA * share;
}

// Rectifies history where it is rejected, and reseeds that of `lanes` where its confidence is less than the least; with
// ALPHA its alpha, too. Returns its inertia: how much it resists this frame's sample, as a weight.
static inline LaneFloat correct_history(COLOUR_TEXELS colour, const ExposedFrame* frame, const SampleMotion* motion,
                                        const NearestSamples* nearest, LaneMask lanes, LaneTexels* history,
                                        LaneFloat* alpha, Evidence* evidence) {
  if (any_lane(evidence->rejection > 0.0f)) rectify_history(colour, frame, nearest, history, alpha, evidence);
  const LaneMask unknown = lanes & (evidence->confidence < CONFIDENCE_MIN);
  if (!any_lane(unknown)) return (LaneFloat)(0.0f);
  return reseed_history(colour, frame, motion, nearest, unknown, history, alpha, &evidence->confidence);
}
