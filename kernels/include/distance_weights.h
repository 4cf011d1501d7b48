// SPDX-License-Identifier: MIT
// Weights of the samples of two frames by their distance, for resolve_reprojected.
#pragma once

#include "arithmetic.h"
#include "bits.h"
#include "resolve_params.h"

// Reprojection of pixels: pixels of the previous frame, and the trust of what lies there.
typedef struct PixelMotion {
  LaneFloat x, y, trust;
} PixelMotion;

// Weights of the 2x2 samples of both frames: a sample's is the product of its column's and its row's. All eight of a
// pixel add up to 1.
typedef struct Weights {
  LaneFloat now_x0, now_x1, now_y0, now_y1;
  LaneFloat before_x0, before_x1, before_y0, before_y1;
} Weights;

// The same of one pixel, ready for pairs of samples.
typedef struct PixelWeights {
  float8 now_x, before_x;
  float now_y0, now_y1, before_y0, before_y1;
} PixelWeights;

#define PIXEL_WEIGHTS(w, i)                                                                         \
  ((PixelWeights){(float8)((float4)(LANE((w).now_x0, i)), (float4)(LANE((w).now_x1, i))),             \
                  (float8)((float4)(LANE((w).before_x0, i)), (float4)(LANE((w).before_x1, i))),       \
                  LANE((w).now_y0, i), LANE((w).now_y1, i), LANE((w).before_y0, i), LANE((w).before_y1, i)})

// The samples of one pixel: a pair a row.
typedef struct FourPairs {
  float8 now0, now1, before0, before1;
} FourPairs;

// (1 - d^2 / r^2)^3, close to a Gaussian of sigma .41 r; 0 from d = r on. `falloff` is 1 / r^2.
static inline LaneFloat distance_weight(LaneFloat distance, float falloff) {
  const LaneFloat rest = max(1.0f - distance * distance * falloff, (LaneFloat)(0.0f));
  return rest * rest * rest;
}

static inline Weights weights_of(const ReprojectedParams* params, LaneFloat now_x, LaneFloat now_y, LaneFloat before_x,
                                 LaneFloat before_y, LaneFloat trust) {
  const LaneFloat rest = 1.0f - trust;
  const LaneFloat left = 1.0f - now_x;
  const LaneFloat above = 1.0f - now_y;
  Weights w;
  w.now_x0 = MULTIPLY_ADD(distance_weight(now_x, params->falloff0_x), trust, left * rest);
  w.now_x1 = MULTIPLY_ADD(distance_weight(left, params->falloff0_x), trust, now_x * rest);
  w.now_y0 = MULTIPLY_ADD(distance_weight(now_y, params->falloff0_y), trust, above * rest);
  w.now_y1 = MULTIPLY_ADD(distance_weight(above, params->falloff0_y), trust, now_y * rest);
  w.before_x0 = distance_weight(before_x, params->falloff1_x);
  w.before_x1 = distance_weight(1.0f - before_x, params->falloff1_x);
  w.before_y0 = distance_weight(before_y, params->falloff1_y) * trust;
  w.before_y1 = distance_weight(1.0f - before_y, params->falloff1_y) * trust;
  const LaneFloat sum = MULTIPLY_ADD(w.before_x0 + w.before_x1, w.before_y0 + w.before_y1,
                                  (w.now_x0 + w.now_x1) * (w.now_y0 + w.now_y1));
  const LaneFloat scale = 1.0f / sum;
  w.now_y0 *= scale;
  w.now_y1 *= scale;
  w.before_y0 *= scale;
  w.before_y1 *= scale;
  return w;
}

static inline float4 blend_samples(FourPairs samples, PixelWeights w) {
  const float8 now = MULTIPLY_ADD(samples.now1, (float8)(w.now_y1), samples.now0 * w.now_y0);
  const float8 before = MULTIPLY_ADD(samples.before1, (float8)(w.before_y1), samples.before0 * w.before_y0);
  const float8 pair = MULTIPLY_ADD(before, w.before_x, now * w.now_x);
  return pair.lo + pair.hi;
}

// Returns the largest magnitudes of the channels, as bits.
static inline int8 magnitudes_of(FourPairs samples) {
  return max(max(as_int8(samples.now0) & 0x7fffffff, as_int8(samples.now1) & 0x7fffffff),
             max(as_int8(samples.before0) & 0x7fffffff, as_int8(samples.before1) & 0x7fffffff));
}

// Whether one of such magnitudes of colour is `bright` or more, one of alpha is 2, or any is infinite or NaN.
static inline bool any_is_bright(int8 magnitudes, float bright) {
  const int4 limits = (int4)((int3)(as_int(bright)), 0x40000000);
  return any_of_eight(magnitudes >= (int8)(limits, limits));
}

// Returns the weight of each sample of a pair, in all its lanes: 1 / max(bright, largest of red, green and blue).
static inline float8 brightness_weight(float8 pair, float bright) {
  return 1.0f / max(max(max(pair.s01204564, pair.s12015645), pair.s20126456), (float8)(bright));
}

static inline float4 blend_bright(FourPairs samples, PixelWeights w, float bright) {
  const float8 now0 = brightness_weight(samples.now0, bright) * w.now_x * w.now_y0;
  const float8 now1 = brightness_weight(samples.now1, bright) * w.now_x * w.now_y1;
  const float8 before0 = brightness_weight(samples.before0, bright) * w.before_x * w.before_y0;
  const float8 before1 = brightness_weight(samples.before1, bright) * w.before_x * w.before_y1;
  const float8 sum = now0 * samples.now0 + now1 * samples.now1 + before0 * samples.before0 + before1 * samples.before1;
  const float8 weight = now0 + now1 + before0 + before1;
  return (sum.lo + sum.hi) / (weight.lo + weight.hi);
}

// Whether one of a pair of samples is not finite and has a weight.
static inline bool counts_non_finite(float8 pair, float x0, float x1, float y) {
  return y != 0.0f && ((x0 != 0.0f && any_non_finite4(pair.lo)) || (x1 != 0.0f && any_non_finite4(pair.hi)));
}

static inline float8 sanitise8(float8 pair) {
  return (float8)(sanitise4(pair.lo), sanitise4(pair.hi));
}
