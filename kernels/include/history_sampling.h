// SPDX-License-Identifier: MIT
// Reading the history between texels.
//
// Option: TAPS  16 (default): cubic | 4: bilinear
#pragma once

#include "history.h"
#include "multiply_add.h"

#ifndef TAPS
#define TAPS 16
#endif
#if TAPS != 16 && TAPS != 4
#error "TAPS must be 16 or 4"
#endif

// 4x4 texels around a place between the middle four.
typedef struct Neighbourhood {
  float16 row0, row1, row2, row3;
} Neighbourhood;

// The texels from (x, y) on, all inside.
static inline Neighbourhood load_neighbourhood(HISTORY_TEXELS texels, int width, int x, int y) {
  const int index = y * width + x;
  const Neighbourhood around = {load_history4(texels, index), load_history4(texels, index + width),
                                load_history4(texels, index + 2 * width), load_history4(texels, index + 3 * width)};
  return around;
}

static inline float16 load_clamped4(HISTORY_TEXELS texels, int width, int height, int x, int y) {
  const int row = clamp(y, 0, height - 1) * width;
  const int last = width - 1;
  return (float16)(load_history(texels, row + clamp(x, 0, last)), load_history(texels, row + clamp(x + 1, 0, last)),
                   load_history(texels, row + clamp(x + 2, 0, last)), load_history(texels, row + clamp(x + 3, 0, last)));
}

// The same anywhere; beyond the edges the outermost texel once more.
static inline Neighbourhood load_neighbourhood_clamped(HISTORY_TEXELS texels, int width, int height, int x, int y) {
  const Neighbourhood around = {load_clamped4(texels, width, height, x, y), load_clamped4(texels, width, height, x, y + 1),
                                load_clamped4(texels, width, height, x, y + 2),
                                load_clamped4(texels, width, height, x, y + 3)};
  return around;
}

// The weights of one axis, of the texels before and after a place; where TAPS is 4 the outer ones are 0.
typedef struct Cubic {
  float8 w0, w1, w2, w3;
} Cubic;

// Keys, "Cubic Convolution Interpolation for Digital Image Processing", 1981, with his `a`.
static inline Cubic cubic_weights(float8 f, float a) {
  const float8 rest = 1.0f - f;
#if TAPS == 4
  const Cubic tent = {(float8)(0.0f), rest, f, (float8)(0.0f)};
  return tent;
#else
  Cubic w;
  w.w0 = a * f * rest * rest;
  w.w3 = a * rest * f * f;
  w.w1 = ((a + 2.0f) * f - (a + 3.0f)) * f * f + 1.0f;
  w.w2 = 1.0f - w.w0 - w.w1 - w.w3;
  return w;
#endif
}

static inline float4 blend_columns(float16 row, float4 w) {
  const float8 pair = MULTIPLY_ADD(row.lo, (float8)((float4)(w.x), (float4)(w.y)), row.hi * (float8)((float4)(w.z), (float4)(w.w)));
  return pair.lo + pair.hi;
}

static inline float4 blend_middle(Neighbourhood around, float4 x, float4 y) {
  const float8 rows = MULTIPLY_ADD(around.row1.s456789ab, (float8)(y.y), around.row2.s456789ab * y.z);
  return MULTIPLY_ADD(rows.lo, (float4)(x.y), rows.hi * x.z);
}

// The cubic, held in the range of the middle four.
static inline float4 sample_neighbourhood(Neighbourhood around, float4 x, float4 y) {
  const float16 outer = MULTIPLY_ADD(around.row0, (float16)(y.x), around.row3 * y.w);
  const float16 rows = MULTIPLY_ADD(around.row1, (float16)(y.y), MULTIPLY_ADD(around.row2, (float16)(y.z), outer));
  const float16 least = min(around.row1, around.row2);
  const float16 most = max(around.row1, around.row2);
  return min(max(blend_columns(rows, x), min(least.s4567, least.s89ab)), max(most.s4567, most.s89ab));
}

// At a place with weights x and y among the 4x4 texels from (x0, y0) on; `inside`: they are all there.
static inline float4 sample_history(HISTORY_TEXELS texels, int width, int height, int x0, int y0, bool inside, float4 x, float4 y) {
  const Neighbourhood around = inside ? load_neighbourhood(texels, width, x0, y0)
                                      : load_neighbourhood_clamped(texels, width, height, x0, y0);
#if TAPS == 4
  return blend_middle(around, x, y);
#else
  return sample_neighbourhood(around, x, y);
#endif
}
