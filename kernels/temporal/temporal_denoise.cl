// SPDX-License-Identifier: MIT
// temporal_denoise: takes the noise of the frames out of the picture of a history. The result is not fed back.
//   t  a colour in tone space, c / (1 + max(red, green, blue, 0)), with W its confidence + .03
//   v  its variance by noise: noise (1 - max(t, 0))^2 |t|^2 / W
//   s  part of it that the picture shows: min(sum of |t - mean of four neighbours|^2 / sum of v, .7), over 5x5 pixels
//   t <- mean of the 7x7 pixels, each weighted W bell(d / (s (v + v of the own ones))), where d, the squared distance,
//        and v are sums over the 3x3 pixels around it and the own ones
//   Where light is smooth, or noise is less than stated, s is small, and texture stays. A pixel of which no channel
//   moves keeps its colour bit by bit.
//   Where the surfaces' albedo is known, all this is done with each channel over max(albedo, 0) + .02, or where that
//   would be more than 32768, with 32768.
//
//   params   in   extents, layouts
//   albedo_layout, has_albedo  in  0: nothing is known of it
//   noise    in   variance of a sample, in parts of its square
//   source   in   RGBA32F or RGBA16F, output extent, linear, premultiplied; a buffer. NaN counts as 0, what is larger
//                 than 65504 as that
//   albedo   in   format and extent as source; a buffer. Read only where it is known
//   history  in   the layer of this frame: of its texels the confidence alone
//   output   out  as source, alpha unchanged; another buffer
//   exposure in   Exposure of this frame: colour is that of exposed light
// Options: SOURCE_FORMAT  HALF (default) | FLOAT   of source; OUTPUT_FORMAT is the same
//          HISTORY_FORMAT as in temporal/history.h
// Beyond the picture its outermost pixels repeat.
// Source: Buades, Coll and Morel, "A non-local algorithm for image denoising", 2005; variances as in Rousselle, Knaus
// and Zwicker, "Adaptive Rendering with Non-Local Means Filtering", 2012.
// Reference: tests/reference/temporal_denoise.cpp
#undef LANES
#define LANES 8  // whatever the device: the pixels of an item share rows, which lie in memory anyway
#include "arithmetic.h"
#include "temporal/constants.h"
#include "temporal/history.h"
#include "temporal/temporal_params.h"
#include "temporal/tone_rows.h"
#include "texel.h"

#if SOURCE_FORMAT != OUTPUT_FORMAT
#error "SOURCE_FORMAT and OUTPUT_FORMAT must be the same"
#endif

enum {  // pixels
  kReach = 3,
  kMiddle = kReach + 1,                // rows above a pixel that its patches need
  kRows = kRefineBlock + 2 * kMiddle,  // of a block
  kRowWithMargins = 16 + 2 * kReach
};

// A row as ToneRow has it. An array: read anywhere by an index, where every other way takes some compilers minutes.
typedef struct NoisyRow {
  float red[kRowWithMargins], green[kRowWithMargins], blue[kRowWithMargins];
  float variance[kRowWithMargins], weight[kRowWithMargins];
} NoisyRow;

// The values that lie `by` to the right of those of a row, `by` at most kReach to either side. Margins hold nothing.
static inline float16 shifted(const float* row, int by) {
  return vload16(0, row + kReach + by);
}

static inline float8 shifted_pixels(const float* row, int by) {
  return vload8(0, row + kReach + kRowMargin + by);
}

static inline void store_row(float16 values, float* row) {
  vstore16(values, 0, row + kReach);
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
    return (float16)(load_confidences8(layer, row + first), load_confidences8(layer, row + first + 8));
  }
  float stored[16];
  for (int i = 0; i < 16; ++i)
    stored[i] = load_confidence(layer, row + clamp(first + i, 0, layer.width - 1));
  return vload16(0, stored);
}

// The picture, and what it is divided by.
typedef struct NoisyPicture {
  RESOLVED_TEXELS source;
  RESOLVED_TEXELS albedo;
  RefineParams params, albedo_params;
  bool has_albedo;
  float exposure;  // factor
} NoisyPicture;

static inline float16 divisor_of(float16 albedo, float16 light) {
  return max(max(albedo, 0.0f) + DENOISED_ALBEDO_FLOOR, fabs(light) * (1.0f / DENOISED_LIGHT_MAX));
}

// What a row of the picture, `light`, is divided by.
static inline LightRow divisors_of(const NoisyPicture* picture, LightRow light, int x, int y) {
  if (!picture->has_albedo) return row_of_ones();
  const LightRow albedo = light_row(picture->albedo, &picture->albedo_params, 1.0f, x, y);
  const LightRow divisors = {divisor_of(albedo.red, light.red), divisor_of(albedo.green, light.green),
                             divisor_of(albedo.blue, light.blue)};
  return divisors;
}

static inline ToneRow tone_over(LightRow light, LightRow divisors) {
  // Not into the parameter: Mesa 22.3 changes the caller's as well.
  const LightRow over = {light.red / divisors.red, light.green / divisors.green, light.blue / divisors.blue};
  return tone_of(over);
}

static inline void load_noisy_row(NoisyRow* row, const NoisyPicture* picture, HistoryLayer layer, float noise, int x,
                                  int y) {
  const LightRow light = light_row(picture->source, &picture->params, picture->exposure, x, y);
  const ToneRow t = tone_over(light, divisors_of(picture, light, x, y));
  const float16 rest = 1.0f - max(max(max(t.red, t.green), t.blue), 0.0f);
  const float16 weight = fabs(confidences_around(layer, x, y)) + DENOISED_CONFIDENCE_FLOOR;
  const float16 square = t.red * t.red + t.green * t.green + t.blue * t.blue;
  store_row(t.red, row->red);
  store_row(t.green, row->green);
  store_row(t.blue, row->blue);
  store_row(noise * rest * rest * square / weight, row->variance);
  store_row(weight, row->weight);
}

// Squared differences of one channel from the mean of the four neighbours.
static inline float16 roughness(const float* above, const float* same, const float* below) {
  const float16 own = shifted(same, 0);
  const float16 around = shifted(above, 0) + shifted(below, 0) + to_the_left(own) + to_the_right(own);
  const float16 apart = own - 0.25f * around;
  return apart * apart;
}

// Returns which part of the variance the pixels of the row in the middle show.
static inline float8 shown_part(const NoisyRow* middle) {
  float16 rough = (float16)(0.0f), variance = (float16)(0.0f);
  for (int i = -2; i <= 2; ++i) {
    const NoisyRow *above = middle + i - 1, *same = middle + i, *below = middle + i + 1;
    rough += roughness(above->red, same->red, below->red) +
             roughness(above->green, same->green, below->green) +
             roughness(above->blue, same->blue, below->blue);
    variance += shifted(same->variance, 0);
  }
  return min(sum_of_five(rough) / (sum_of_five(variance) + DENOISED_VARIANCE_MIN), DENOISED_PART_MAX);
}

// The weights of the pixels that lie (dx, dy) from those of the row in the middle.
static inline float8 likeness(const NoisyRow* middle, float8 part, int dx, int dy) {
  float16 distance = (float16)(0.0f), variance = (float16)(0.0f);
  for (int i = -1; i <= 1; ++i) {
    const NoisyRow *own = middle + i, *other = middle + i + dy;
    const float16 red = shifted(own->red, 0) - shifted(other->red, dx);
    const float16 green = shifted(own->green, 0) - shifted(other->green, dx);
    const float16 blue = shifted(own->blue, 0) - shifted(other->blue, dx);
    distance += red * red + green * green + blue * blue;
    variance += shifted(own->variance, 0) + shifted(other->variance, dx);
  }
  const float8 apart = sum_of_three(distance) / (part * sum_of_three(variance) + DENOISED_DISTANCE_MIN);
  return bell8(apart) * shifted_pixels(middle[dy].weight, dx);
}

// Denoises the pixels from (x, y) on, of the row in the middle.
static inline void denoise_row(const NoisyRow* middle, const NoisyPicture* picture, OUTPUT_TEXELS output, int x,
                               int y) {
  const LightRow light = light_row(picture->source, &picture->params, picture->exposure, x, y);
  const LightRow divisors = divisors_of(picture, light, x, y);
  const ToneRow own = tone_over(light, divisors);
  const float8 part = shown_part(middle), zero = (float8)(0.0f);
  float8 red = zero, green = zero, blue = zero, sum = zero;
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      const NoisyRow* other = middle + dy;
      const float8 weight = likeness(middle, part, dx, dy);
      red += weight * (shifted_pixels(other->red, dx) - at_pixels(own.red));
      green += weight * (shifted_pixels(other->green, dx) - at_pixels(own.green));
      blue += weight * (shifted_pixels(other->blue, dx) - at_pixels(own.blue));
      sum += weight;
    }
  }
  store_tone(output, picture->source, &picture->params, x, y, light, divisors, own, at_pixels(own.red) + red / sum,
             at_pixels(own.green) + green / sum, at_pixels(own.blue) + blue / sum, 1.0f / picture->exposure);
}

__kernel void temporal_denoise(const RefineParams params, const TexelLayout albedo_layout, int has_albedo, float noise,
                               RESOLVED_TEXELS source, RESOLVED_TEXELS albedo, HISTORY_TEXELS history,
                               OUTPUT_TEXELS output, __global const Exposure* exposure) {
  const int top = get_global_id(1) * kRefineBlock;
  if (top >= params.height) return;

  const HistoryLayer layer = {history, params.width, params.height};
  NoisyPicture picture = {source, albedo, params, params, has_albedo != 0, exposure->factor};
  picture.albedo_params.source = albedo_layout;
  const int stride = (int)get_global_size(0) * kRefineBlock;
  const int bottom = min(top + kRefineBlock, params.height);
  for (int x = get_global_id(0) * kRefineBlock; x < params.width; x += stride) {
    NoisyRow rows[kRows];
    for (int i = 0; i < kRows; ++i)
      load_noisy_row(rows + i, &picture, layer, noise, x, top - kMiddle + i);
    for (int y = top; y < bottom; ++y)
      denoise_row(rows + y - top + kMiddle, &picture, output, x, y);
  }
}
