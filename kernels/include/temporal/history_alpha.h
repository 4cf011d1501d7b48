// SPDX-License-Identifier: MIT
// Alpha of a layer of history: a plane of its own beside the layer, one value for each of its texels, in the layer's
// format and order. It is read at the same places and with the same weights as colour.
#pragma once

#include "temporal/history_sampling.h"

// A plane to read.
typedef struct AlphaPlane {
  HISTORY_TEXELS texels;
  int width, height;  // the output extent
} AlphaPlane;

static inline float load_alpha(AlphaPlane plane, int index) {
#if HISTORY_FORMAT == HALF
  return vload_half(index, plane.texels);
#else
  return plane.texels[index];
#endif
}

// The values index to index + 7.
static inline float8 load_alpha8(AlphaPlane plane, int index) {
#if HISTORY_FORMAT == HALF
  // Through private memory: vload_half8 would want 16-byte alignment.
  const ushort8 bits = vload8(0, (__global const ushort*)plane.texels + index);
  return vload_half8(0, (__private const half*)&bits);
#else
  return vload8(0, plane.texels + index);
#endif
}

// The first `count` of eight.
static inline void store_alpha8(STORED_HISTORY texels, int index, int count, float8 alpha) {
  float value[8];
  vstore8(clamp(alpha, -65504.0f, 65504.0f), 0, value);
  for (int i = 0; i < min(count, 8); ++i) {
#if HISTORY_FORMAT == HALF
    vstore_half_rte(value[i], index + i, texels);
#else
    texels[index + i] = value[i];
#endif
  }
}

// The four values from (x, y) on, clamped to the edge.
static inline float4 load_alpha_clamped4(AlphaPlane plane, int x, int y) {
  const int row = clamp(y, 0, plane.height - 1) * plane.width;
  const int last = plane.width - 1;
  return (float4)(load_alpha(plane, row + clamp(x, 0, last)), load_alpha(plane, row + clamp(x + 1, 0, last)),
                  load_alpha(plane, row + clamp(x + 2, 0, last)), load_alpha(plane, row + clamp(x + 3, 0, last)));
}

// What sample_history gives, of alpha.
static inline float sample_alpha(AlphaPlane plane, int x0, int y0, float4 x, float4 y) {
  const float4 row1 = load_alpha_clamped4(plane, x0, y0 + 1), row2 = load_alpha_clamped4(plane, x0, y0 + 2);
#if TAPS == 4
  return dot(MULTIPLY_ADD(row1, (float4)(y.y), row2 * y.z), x);
#else
  const float4 row0 = load_alpha_clamped4(plane, x0, y0), row3 = load_alpha_clamped4(plane, x0, y0 + 3);
  const float4 outer = MULTIPLY_ADD(row0, (float4)(y.x), row3 * y.w);
  const float4 rows = MULTIPLY_ADD(row1, (float4)(y.y), MULTIPLY_ADD(row2, (float4)(y.z), outer));
  const float2 least = min(row1.yz, row2.yz), most = max(row1.yz, row2.yz);
  return min(max(dot(rows, x), min(least.x, least.y)), max(most.x, most.y));
#endif
}
