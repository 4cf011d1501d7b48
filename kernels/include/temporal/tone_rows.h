// SPDX-License-Identifier: MIT
// Rows of a picture in tone space, sixteen texels at a time, for kernels that look around the pixels in the lanes; and
// the way back.
//
// Options: SOURCE_FORMAT, OUTPUT_FORMAT as in texel.h
#pragma once

#include "bits.h"
#include "picture_params.h"
#include "temporal/constants.h"
#include "temporal/history.h"
#include "temporal/temporal_params.h"
#include "texel.h"

enum { kRowMargin = 4 };  // texels before the pixels of a row

// Sixteen texels of a row; the pixels are those of kRowMargin on.
typedef struct ToneRow {
  float16 red, green, blue, luma;
} ToneRow;

#if LANES == 8
#define at_pixels(row) ((row).s456789ab)
#define on_the_left(row) ((row).s3456789a)
#define on_the_right(row) ((row).s56789abc)
#else
#define at_pixels(row) ((row).s4)
#define on_the_left(row) ((row).s3)
#define on_the_right(row) ((row).s5)
#endif

// Each texel's left and right neighbour; the outermost texel stands in for what lies beyond.
static inline float16 to_the_left(float16 row) {
  return row.s00123456789abcde;
}

static inline float16 to_the_right(float16 row) {
  return row.s123456789abcdeff;
}

// The confidences of the eight texels from `index` on.
static inline float8 load_confidences8(HistoryLayer layer, int index) {
  return (float8)(load_history4(layer, index).s37bf, load_history4(layer, index + 4).s37bf);
}

// The four texels from (x, y) on, clamped to the edge.
static inline float16 load_clamped_texels4(RESOLVED_TEXELS source, const RefineParams* params, int x, int y) {
  const int last = params->width - 1;
  if (x >= 0 && x + 3 <= last) return load_resolved4(source, params->source, x, y);
  return (float16)(load_resolved(source, params->source, clamp(x, 0, last), y),
                   load_resolved(source, params->source, clamp(x + 1, 0, last), y),
                   load_resolved(source, params->source, clamp(x + 2, 0, last), y),
                   load_resolved(source, params->source, clamp(x + 3, 0, last), y));
}

// NaN becomes 0; the rest is held within the largest half.
static inline float16 cleaned(float16 values) {
  const int16 is_nan = (as_int16(values) & 0x7fffffff) > 0x7f800000;
  const float16 known = as_float16(as_int16(values) & ~is_nan);
  return min(max(known, -FINITE_HALF_MAX), FINITE_HALF_MAX);
}

// Sixteen texels in exposed light, cleaned.
typedef struct LightRow {
  float16 red, green, blue;
} LightRow;

// Those around the pixels from (x, y) on; the row clamped to the edge, too.
static inline LightRow light_row(RESOLVED_TEXELS source, const RefineParams* params, float exposure, int x, int y) {
  const int row = clamp(y, 0, params->height - 1);
  const float16 t0 = load_clamped_texels4(source, params, x - kRowMargin, row);
  const float16 t1 = load_clamped_texels4(source, params, x, row);
  const float16 t2 = load_clamped_texels4(source, params, x + 4, row);
  const float16 t3 = load_clamped_texels4(source, params, x + 8, row);
  const LightRow light = {cleaned((float16)(t0.s048c, t1.s048c, t2.s048c, t3.s048c) * exposure),
                          cleaned((float16)(t0.s159d, t1.s159d, t2.s159d, t3.s159d) * exposure),
                          cleaned((float16)(t0.s26ae, t1.s26ae, t2.s26ae, t3.s26ae) * exposure)};
  return light;
}

static inline LightRow row_of_ones(void) {
  const LightRow ones = {(float16)(1.0f), (float16)(1.0f), (float16)(1.0f)};
  return ones;
}

static inline ToneRow tone_of(LightRow light) {
  const float16 scale = 1.0f / (1.0f + max(max(max(light.red, light.green), light.blue), 0.0f));
  ToneRow tone = {light.red * scale, light.green * scale, light.blue * scale, (float16)(0.0f)};
  tone.luma = 0.25f * (tone.red + tone.blue) + 0.5f * tone.green;
  return tone;
}

// Light of values in tone space; of those that stay, as it was.
static inline LaneFloat light_of(LaneFloat tone, LaneFloat scale, LaneFloat before, LaneMask stays) {
  return select(min(max(tone * scale, -FINITE_HALF_MAX), FINITE_HALF_MAX), before, stays);
}

// The first `count` pixels of a row, with the alpha of `source`.
static inline void store_light(OUTPUT_TEXELS output, RESOLVED_TEXELS source, const RefineParams* params,
                               int x, int y, int count, LaneFloat red, LaneFloat green, LaneFloat blue) {
  float reds[kLanes], greens[kLanes], blues[kLanes];
  STORE_LANES(red, reds);
  STORE_LANES(green, greens);
  STORE_LANES(blue, blues);
  for (int i = 0; i < count; ++i) {
    const float alpha = load_resolved(source, params->source, x + i, y).w;
    store_output(output, params->output, x + i, y, (float4)(reds[i], greens[i], blues[i], alpha));
  }
}

// Stores the pixels from (x, y) on, whose light was `light` and tone `before`, that of light over `factors`. Those of
// which no channel has moved keep their light. `inverse`: Exposure's.
static inline void store_tone(OUTPUT_TEXELS output, RESOLVED_TEXELS source, const RefineParams* params,
                              int x, int y, LightRow light, LightRow factors, ToneRow before, LaneFloat red,
                              LaneFloat green, LaneFloat blue, float inverse) {
  const LaneMask stays =
      (red == at_pixels(before.red)) & (green == at_pixels(before.green)) & (blue == at_pixels(before.blue));
  const LaneFloat brightest = max(max(max(red, green), blue), 0.0f);
  const LaneFloat scale = 1.0f / max(1.0f - brightest, TONE_REST_MIN);
  store_light(output, source, params, x, y, min(params->width - x, (int)kLanes),
              light_of(red, scale * at_pixels(factors.red), at_pixels(light.red), stays) * inverse,
              light_of(green, scale * at_pixels(factors.green), at_pixels(light.green), stays) * inverse,
              light_of(blue, scale * at_pixels(factors.blue), at_pixels(light.blue), stays) * inverse);
}
