// SPDX-License-Identifier: MIT
// Rectification and reseeding of eight output pixels of a row.
#pragma once

#include "temporal/alpha.h"
#include "temporal/limit_confidence.h"
#include "temporal/rectify.h"
#include "temporal/reseed.h"

// How much a seed resists its first sample, of a whole seed: that sample is in the seed already. +.01 dB, +.05 to +.1
// in first frames (docs/temporal.md).
#define INERTIA 0.85f

static inline bool needs_correction(const Evidence* evidence) {
  return any_lane((evidence->rejection > 0.0f) | (evidence->confidence < LEAST_CONFIDENCE));
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
  const float8 share = select(none, 1.0f - *confidence / LEAST_CONFIDENCE, lanes);
  history->left += (seeds.mean.left - history->left) * to_four_texels(share.lo);
  history->right += (seeds.mean.right - history->right) * to_four_texels(share.hi);
#if ALPHA
  *alpha += (confidences(seeds.mean) - *alpha) * share;
#endif
  *confidence = select(*confidence, select(none, (float8)(LEAST_CONFIDENCE), seeds.known), lanes);
  return INERTIA * share;
}

// Rectifies history where it is rejected, and reseeds that of `lanes` where its confidence is less than the least; with
// ALPHA its alpha, too. Returns its inertia: how much it resists this frame's sample, as a weight.
static inline float8 correct_history(COLOUR_TEXELS colour, const SourceFrame* frame, const SampleMotion* motion,
                                     const NearestSamples* nearest, int8 lanes, EightTexels* history, float8* alpha,
                                     Evidence* evidence) {
  if (any_lane(evidence->rejection > 0.0f)) rectify_history(colour, frame, nearest, history, alpha, evidence);
  const int8 unknown = lanes & (evidence->confidence < LEAST_CONFIDENCE);
  if (!any_lane(unknown)) return (float8)(0.0f);
  return reseed_history(colour, frame, motion, nearest, unknown, history, alpha, &evidence->confidence);
}
