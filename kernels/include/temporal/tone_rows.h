// SPDX-License-Identifier: MIT
// Rows of a resolved picture in tone space, c / (1 + max c), channel by channel: eight pixels and four on each side.
//
// Options: SOURCE_FORMAT as in texel.h
#pragma once

#include "sanitise.h"
#include "temporal/refine_params.h"
#include "texel.h"

enum { kRowMargin = 4 };  // texels before the eight pixels of a row, and after them

#define DARKEST_REFINED 0x1p-16f  // of 1 - max tone: where rounding would make the way back infinite

// Sixteen texels of a row; the pixels are the middle eight.
typedef struct ToneRow {
  float16 red, green, blue, luma;
} ToneRow;

static inline float8 at_pixels(float16 row) {
  return row.s456789ab;
}

static inline float8 on_the_left(float16 row) {
  return row.s3456789a;
}

static inline float8 on_the_right(float16 row) {
  return row.s56789abc;
}

// Each texel's left and right neighbour; the outermost texel stands in for what lies beyond.
static inline float16 to_the_left(float16 row) {
  return row.s00123456789abcde;
}

static inline float16 to_the_right(float16 row) {
  return row.s123456789abcdeff;
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
  return min(max(known, -INFINITY_STAND_IN), INFINITY_STAND_IN);
}

// Sixteen texels as they were drawn, cleaned.
typedef struct LightRow {
  float16 red, green, blue;
} LightRow;

// Those around the pixels from (x, y) on; the row clamped to the edge, too.
static inline LightRow light_row(RESOLVED_TEXELS source, const RefineParams* params, int x, int y) {
  const int row = clamp(y, 0, params->height - 1);
  const float16 t0 = load_clamped_texels4(source, params, x - kRowMargin, row);
  const float16 t1 = load_clamped_texels4(source, params, x, row);
  const float16 t2 = load_clamped_texels4(source, params, x + 4, row);
  const float16 t3 = load_clamped_texels4(source, params, x + 8, row);
  const LightRow light = {cleaned((float16)(t0.s048c, t1.s048c, t2.s048c, t3.s048c)),
                          cleaned((float16)(t0.s159d, t1.s159d, t2.s159d, t3.s159d)),
                          cleaned((float16)(t0.s26ae, t1.s26ae, t2.s26ae, t3.s26ae))};
  return light;
}

static inline ToneRow tone_of(LightRow light) {
  const float16 scale = 1.0f / (1.0f + max(max(max(light.red, light.green), light.blue), 0.0f));
  ToneRow tone = {light.red * scale, light.green * scale, light.blue * scale, (float16)(0.0f)};
  tone.luma = 0.25f * (tone.red + tone.blue) + 0.5f * tone.green;
  return tone;
}
