// SPDX-License-Identifier: MIT
// temporal_denoise: the picture of a history without the noise of its frames. It is not fed back.
//   t  a colour in tone space, c / (1 + max(red, green, blue, 0)), with W its confidence + .03
//   v  variance that chance gives it: noise (1 - max(t, 0))^2 |t|^2 / W
//   s  part of it that the picture shows: min(sum of |t - mean of four neighbours|^2 / sum of v, .7), over 5x5 pixels
//   t <- mean of the 7x7 pixels, each weighted W bell(d / (s (v + v of the own ones))), where d, the squared distance,
//        and v are sums over the 3x3 pixels around it and the own ones
//   Where light is smooth, or noise is less than told, s is small, and texture stays. A pixel of which no channel
//   moves keeps its colour bit by bit.
//
//   params   in   extents, layouts
//   noise    in   variance of a sample, in parts of its square
//   source   in   RGBA32F or RGBA16F, output extent, linear, premultiplied; a buffer. NaN counts as 0, what is larger
//                 than 65504 as that
//   history  in   the layer of this frame: of its texels the confidence alone
//   output   out  as source, alpha unchanged; another buffer
// Options: SOURCE_FORMAT  HALF (default) | FLOAT   of source; OUTPUT_FORMAT is the same
//          HISTORY_FORMAT as in temporal/history.h
// Beyond the picture its outermost pixels repeat.
// Source: Buades, Coll and Morel, "A non-local algorithm for image denoising", 2005; variances as in Rousselle, Knaus
// and Zwicker, "Adaptive Rendering with Non-Local Means Filtering", 2012.
// Reference: tests/reference/temporal_denoise.cpp
#include "arithmetic.h"
#include "temporal/constants.h"
#include "temporal/history.h"
#include "temporal/temporal_params.h"
#include "temporal/tone_rows.h"
#include "texel.h"

#if SOURCE_FORMAT != OUTPUT_FORMAT
#error "SOURCE_FORMAT and OUTPUT_FORMAT must be the same"
#endif

#define DENOISED_CONFIDENCE_FLOOR 0.03f  // weights: pixels of which nothing is known count, too
#define DENOISED_PART_MAX 0.7f           // of the variance that the noise told gives; 1.5: -.14 dB
#define DENOISED_VARIANCE_MIN 1e-12f     // squared tone, of 25 pixels: against a division by 0
#define DENOISED_DISTANCE_MIN 1e-7f      // squared tone, of 9 pixels: what rounding to halves moves

enum {  // pixels; rows around a pixel and its patch
  kReach = 3,
  kMiddle = kReach + 1,
  kRows = 2 * kMiddle + 1
};

typedef struct NoisyRow {
  ToneRow tone;
  float16 variance, weight;
} NoisyRow;

// As far as a row reaches.
static inline float16 shifted(float16 row, int by) {
  switch (by) {
    case -3:
      return row.s0000123456789abc;
    case -2:
      return row.s000123456789abcd;
    case -1:
      return to_the_left(row);
    case 1:
      return to_the_right(row);
    case 2:
      return row.s23456789abcdefff;
    case 3:
      return row.s3456789abcdeffff;
  }
  return row;
}

static inline float8 sum_of_three(float16 row) {
  return on_the_left(row) + at_pixels(row) + on_the_right(row);
}

static inline float8 sum_of_five(float16 row) {
  return sum_of_three(row) + row.s23456789 + row.s6789abcd;
}

// The confidences of the texels of a row, as ToneRow has them.
static inline float16 confidences_around(HistoryLayer layer, int x, int y) {
  const int row = clamp(y, 0, layer.height - 1) * layer.width, first = x - kRowMargin;
  if (first >= 0 && first + 16 <= layer.width) {
    return (float16)(confidences(load_history8(layer, row + first)),
                     confidences(load_history8(layer, row + first + 8)));
  }
  float stored[16];
  for (int i = 0; i < 16; ++i)
    stored[i] = load_confidence(layer, row + clamp(first + i, 0, layer.width - 1));
  return vload16(0, stored);
}

static inline NoisyRow noisy_row(RESOLVED_TEXELS source, HistoryLayer layer, const RefineParams* params,
                                 float noise, int x, int y) {
  const ToneRow t = tone_of(light_row(source, params, x, y));
  const float16 rest = 1.0f - max(max(max(t.red, t.green), t.blue), 0.0f);
  const float16 weight = fabs(confidences_around(layer, x, y)) + DENOISED_CONFIDENCE_FLOOR;
  const float16 square = t.red * t.red + t.green * t.green + t.blue * t.blue;
  const NoisyRow row = {t, noise * rest * rest * square / weight, weight};
  return row;
}

// Squared differences of one channel from the mean of the four neighbours.
static inline float16 roughness(float16 above, float16 same, float16 below) {
  const float16 apart = same - 0.25f * (above + below + to_the_left(same) + to_the_right(same));
  return apart * apart;
}

// Returns which part of the variance the pixels of the middle row show.
static inline float8 shown_part(const NoisyRow* rows) {
  float16 rough = (float16)(0.0f), variance = (float16)(0.0f);
  for (int i = kMiddle - 2; i <= kMiddle + 2; ++i) {
    const ToneRow above = rows[i - 1].tone, same = rows[i].tone, below = rows[i + 1].tone;
    rough += roughness(above.red, same.red, below.red) + roughness(above.green, same.green, below.green) +
             roughness(above.blue, same.blue, below.blue);
    variance += rows[i].variance;
  }
  return min(sum_of_five(rough) / (sum_of_five(variance) + DENOISED_VARIANCE_MIN), DENOISED_PART_MAX);
}

// The weights of the pixels that lie (dx, dy) from those of the middle row.
static inline float8 likeness(const NoisyRow* rows, float8 part, int dx, int dy) {
  float16 distance = (float16)(0.0f), variance = (float16)(0.0f);
  for (int i = kMiddle - 1; i <= kMiddle + 1; ++i) {
    const NoisyRow *own = rows + i, *other = rows + i + dy;
    const float16 red = own->tone.red - shifted(other->tone.red, dx);
    const float16 green = own->tone.green - shifted(other->tone.green, dx);
    const float16 blue = own->tone.blue - shifted(other->tone.blue, dx);
    distance += red * red + green * green + blue * blue;
    variance += own->variance + shifted(other->variance, dx);
  }
  const float8 apart = sum_of_three(distance) / (part * sum_of_three(variance) + DENOISED_DISTANCE_MIN);
  return bell(apart) * at_pixels(shifted(rows[kMiddle + dy].weight, dx));
}

// Denoises the pixels from (x, y) on, in the middle of the rows.
static inline void denoise_row(const NoisyRow* rows, LightRow light, RESOLVED_TEXELS source,
                               OUTPUT_TEXELS output, const RefineParams* params, int x, int y) {
  const float8 part = shown_part(rows), zero = (float8)(0.0f);
  float8 red = zero, green = zero, blue = zero, sum = zero;
  const ToneRow own = rows[kMiddle].tone;
  for (int dy = -kReach; dy <= kReach; ++dy) {
    const ToneRow other = rows[kMiddle + dy].tone;
    UNROLL(7)
    for (int dx = -kReach; dx <= kReach; ++dx) {
      const float8 weight = likeness(rows, part, dx, dy);
      red += weight * at_pixels(shifted(other.red, dx) - own.red);
      green += weight * at_pixels(shifted(other.green, dx) - own.green);
      blue += weight * at_pixels(shifted(other.blue, dx) - own.blue);
      sum += weight;
    }
  }
  store_tone8(output, source, params, x, y, light, own, at_pixels(own.red) + red / sum,
              at_pixels(own.green) + green / sum, at_pixels(own.blue) + blue / sum);
}

__kernel void temporal_denoise(const RefineParams params, float noise, RESOLVED_TEXELS source,
                               HISTORY_TEXELS history, OUTPUT_TEXELS output) {
  const int top = get_global_id(1) * kRefineBlock;
  if (top >= params.height) return;

  const HistoryLayer layer = {history, params.width, params.height};
  const int stride = (int)get_global_size(0) * kRefineBlock;
  const int bottom = min(top + kRefineBlock, params.height);
  for (int x = get_global_id(0) * kRefineBlock; x < params.width; x += stride) {
    NoisyRow rows[kRows];
    for (int i = 1; i < kRows; ++i)
      rows[i] = noisy_row(source, layer, &params, noise, x, top - kMiddle - 1 + i);
    for (int y = top; y < bottom; ++y) {
      for (int i = 0; i < kRows - 1; ++i)
        rows[i] = rows[i + 1];
      rows[kRows - 1] = noisy_row(source, layer, &params, noise, x, y + kMiddle);
      denoise_row(rows, light_row(source, &params, x, y), source, output, &params, x, y);
    }
  }
}
