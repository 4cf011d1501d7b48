// SPDX-License-Identifier: MIT
// The history of the temporal upscaler: always a tight buffer of the output extent, RGB and confidence in each texel.
//
// Option: HISTORY_FORMAT  FLOAT (default) | HALF
#pragma once

#include "texel.h"

#ifndef HISTORY_FORMAT
#define HISTORY_FORMAT FLOAT
#endif
#if HISTORY_FORMAT != FLOAT && HISTORY_FORMAT != HALF
#error "HISTORY_FORMAT must be FLOAT or HALF"
#endif

#if HISTORY_FORMAT == HALF
#define HISTORY_TEXELS __global const half*
#define STORED_HISTORY __global half*
#else
#define HISTORY_TEXELS __global const float*
#define STORED_HISTORY __global float*
#endif

static inline float4 load_history(HISTORY_TEXELS texels, int index) {
#if HISTORY_FORMAT == HALF
  return vload_half4(index, texels);
#else
  return vload4(index, texels);
#endif
}

// Eight pixels of a row, in fours.
typedef struct EightTexels {
  float16 left, right;
} EightTexels;

// The texels index to index + 3.
static inline float16 load_history4(HISTORY_TEXELS texels, int index) {
#if HISTORY_FORMAT == HALF
  return load_half_texels4(texels, index);
#else
  return vload16(0, texels + 4 * index);
#endif
}

static inline EightTexels load_history8(HISTORY_TEXELS texels, int index) {
  const EightTexels row = {load_history4(texels, index), load_history4(texels, index + 4)};
  return row;
}

// Each value to the four channels of a texel.
static inline float16 to_four_texels(float4 value) {
  return (float16)((float4)(value.x), (float4)(value.y), (float4)(value.z), (float4)(value.w));
}

// The confidences of eight texels.
static inline float8 confidences(EightTexels texels) {
  return (float8)(texels.left.s37bf, texels.right.s37bf);
}

// Finite values. Halves are rounded to the nearest: the samples differ by more than their steps.
static inline void store_history(STORED_HISTORY texels, int index, float4 value) {
#if HISTORY_FORMAT == HALF
  vstore_half4_rte(clamp(value, -65504.0f, 65504.0f), index, texels);
#else
  vstore4(value, index, texels);
#endif
}

// The same to the texels index to index + 3.
static inline void store_history4(STORED_HISTORY texels, int index, float16 value) {
#if HISTORY_FORMAT == HALF
  store_half_texels4(texels, index, clamp(value, -65504.0f, 65504.0f));
#else
  vstore16(value, 0, texels + 4 * index);
#endif
}

// The first `count` of eight.
static inline void store_history8(STORED_HISTORY texels, int index, int count, EightTexels row) {
  if (count >= 8) {
    store_history4(texels, index, row.left);
    store_history4(texels, index + 4, row.right);
    return;
  }
  float4 texel[8];
  vstore16(row.left, 0, (float*)texel);
  vstore16(row.right, 1, (float*)texel);
  for (int i = 0; i < count; ++i) store_history(texels, index + i, texel[i]);
}
