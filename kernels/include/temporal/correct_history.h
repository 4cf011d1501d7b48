// SPDX-License-Identifier: MIT
// Rectification and reseeding of eight output pixels, one by one: slow, and seldom needed.
#pragma once

#include "temporal/alpha.h"
#include "temporal/limit_confidence.h"
#include "temporal/rectify.h"
#include "temporal/reseed.h"

// How much a seed resists its first sample, of a whole seed: that sample is in the seed already. +.01 dB, +.05 to +.1
// in first frames (docs/temporal.md).
#define INERTIA 0.85f

// Eight pixels as arrays.
typedef struct EightPixels {
  float4 history[8];
  float confidence[8], rejection[8], from_x[8];
  float inertia[8];
  float alpha[8];
  int x[8];
} EightPixels;

static inline void correct_pixel(COLOUR_TEXELS colour, const SourceFrame* frame, const SampleMotion* motion,
                                 EightPixels* pixels, int i, int y, float from_y) {
  float4 m = pixels->history[i];
  float w = pixels->confidence[i];
  pixels->inertia[i] = 0.0f;
  if (pixels->rejection[i] > 0.0f) {
    const ToneBox box = tone_box(colour, frame, pixels->x[i], y);
    m = rectify(m, w, pixels->rejection[i], &box);
    w = m.w;
#if ALPHA
    pixels->alpha[i] = rectify_alpha(colour, frame, pixels->x[i], y, pixels->alpha[i], pixels->rejection[i]);
#endif
  }
  if (w < LEAST_CONFIDENCE) {
    const Seed seed = seed_of(colour, frame, motion, pixels->x[i], y, pixels->from_x[i], from_y);
    const float share = 1.0f - w / LEAST_CONFIDENCE;
    m += (seed.mean - m) * share;
#if ALPHA
    pixels->alpha[i] += (seed.mean.w - pixels->alpha[i]) * share;
#endif
    pixels->inertia[i] = INERTIA * share;
    w = seed.any ? LEAST_CONFIDENCE : 0.0f;
  }
  pixels->history[i] = m;
  pixels->confidence[i] = w;
}

static inline bool needs_correction(const Evidence* evidence) {
  return any_lane((evidence->rejection > 0.0f) | (evidence->confidence < LEAST_CONFIDENCE));
}

static inline EightPixels load_pixels(const NearestSamples* nearest, const EightTexels* history, float8 alpha,
                                      const Evidence* evidence) {
  EightPixels pixels;
  vstore16(history->left, 0, (float*)pixels.history);
  vstore16(history->right, 1, (float*)pixels.history);
  vstore8(evidence->confidence, 0, pixels.confidence);
  vstore8(evidence->rejection, 0, pixels.rejection);
  vstore8(nearest->from_x, 0, pixels.from_x);
  vstore8(nearest->x, 0, pixels.x);
#if ALPHA
  vstore8(alpha, 0, pixels.alpha);
#endif
  return pixels;
}

// Returns their inertia.
static inline float8 take_pixels(const EightPixels* pixels, EightTexels* history, float8* alpha, Evidence* evidence) {
  history->left = vload16(0, (const float*)pixels->history);
  history->right = vload16(1, (const float*)pixels->history);
  evidence->confidence = vload8(0, pixels->confidence);
#if ALPHA
  *alpha = vload8(0, pixels->alpha);
#endif
  return vload8(0, pixels->inertia);
}

// Rectifies history where it is rejected, and reseeds it where its confidence is less than the least; with ALPHA its
// alpha, too. Returns its inertia: how much it resists this frame's sample, as a weight.
static inline float8 correct_history(COLOUR_TEXELS colour, const SourceFrame* frame, const SampleMotion* motion,
                                     const NearestSamples* nearest, EightTexels* history, float8* alpha,
                                     Evidence* evidence) {
  EightPixels pixels = load_pixels(nearest, history, *alpha, evidence);
  for (int i = 0; i < 8; ++i)
    correct_pixel(colour, frame, motion, &pixels, i, nearest->y, nearest->from_y);
  return take_pixels(&pixels, history, alpha, evidence);
}
