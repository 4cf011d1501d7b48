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
  // Through private memory, as in load_colour_pair.
  __global const uint* words = (__global const uint*)texels + 2 * index;
  const uint4 lower = vload4(0, words);
  const uint4 upper = vload4(1, words);
  return (float16)(vload_half8(0, (__private const half*)&lower), vload_half8(0, (__private const half*)&upper));
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
