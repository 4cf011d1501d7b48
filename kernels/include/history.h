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

// The texels index to index + 3.
static inline float16 load_history4(HISTORY_TEXELS texels, int index) {
#if HISTORY_FORMAT == HALF
  return load_half_texels4(texels, index);
#else
  return vload16(0, texels + 4 * index);
#endif
}

// Finite values. Halves are rounded to the nearest: the samples differ by more than their steps.
static inline void store_history(STORED_HISTORY texels, int index, float4 value) {
#if HISTORY_FORMAT == HALF
  vstore_half4_rte(clamp(value, -65504.0f, 65504.0f), index, texels);
#else
  vstore4(value, index, texels);
#endif
}
