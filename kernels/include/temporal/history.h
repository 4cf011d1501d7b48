// SPDX-License-Identifier: MIT
// A layer of the temporal upscaler's history and its alpha, and how both are loaded and stored. This is the only place
// that knows how a layer lies in memory: a tight buffer of the output extent, row by row, in each texel red, green and
// blue and, in place of alpha, their confidence, the sum of the weights of the samples in it.
//
// Option: HISTORY_FORMAT  FLOAT (default) | HALF
#pragma once

#include "bits.h"
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

// A layer to read: all that a frame knows of the frames before it.
typedef struct HistoryLayer {
  HISTORY_TEXELS texels;
  int width, height;  // the output extent
} HistoryLayer;

static inline float4 load_history(HistoryLayer layer, int index) {
#if HISTORY_FORMAT == HALF
  return vload_half4(index, layer.texels);
#else
  return vload4(index, layer.texels);
#endif
}

static inline float load_confidence(HistoryLayer layer, int index) {
#if HISTORY_FORMAT == HALF
  return vload_half(4 * index + 3, layer.texels);
#else
  return layer.texels[4 * index + 3];
#endif
}

// Less than 0 if the confidence is stored with a minus sign, even -0.
static inline int confidence_sign(HistoryLayer layer, int index) {
#if HISTORY_FORMAT == HALF
  return ((__global const short*)layer.texels)[4 * index + 3];
#else
  return ((__global const int*)layer.texels)[4 * index + 3];
#endif
}

// The texels index and index + 1.
static inline float8 load_history2(HistoryLayer layer, int index) {
#if HISTORY_FORMAT == HALF
  // Through private memory, as in load_half_texels4.
  const uint4 bits = vload4(0, (__global const uint*)layer.texels + 2 * index);
  return vload_half8(0, (__private const half*)&bits);
#else
  return vload8(0, layer.texels + 4 * index);
#endif
}

// The texels index to index + 3.
static inline float16 load_history4(HistoryLayer layer, int index) {
#if HISTORY_FORMAT == HALF
  return load_half_texels4(layer.texels, index);
#else
  return vload16(0, layer.texels + 4 * index);
#endif
}

// The texels from `index` on, one a lane.
static inline LaneTexels load_history_lanes(HistoryLayer layer, int index) {
#if LANES == 8
  const LaneTexels row = {load_history4(layer, index), load_history4(layer, index + 4)};
  return row;
#else
  return load_history(layer, index);
#endif
}

// The texels at the lanes' indices.
static inline LaneTexels gather_history(HistoryLayer layer, LaneInt index) {
#if HISTORY_FORMAT == HALF
  return gather_half_texels(layer.texels, index);
#else
  return gather_float_texels(layer.texels, index);
#endif
}

// The texel at `index`, which may lie anywhere, is read soon.
static inline void will_read_history(HistoryLayer layer, int index) {
  WILL_READ(layer.texels + 4 * index);
}

// The channels of four texels that are their last ones.
#define LAST_CHANNELS ((int16)(0, 0, 0, -1, 0, 0, 0, -1, 0, 0, 0, -1, 0, 0, 0, -1))

static inline LaneFloat confidences(LaneTexels texels) {
  return last_channels(texels);
}

// Finite values. Halves are rounded to the nearest, not dithered: the samples differ by more than their steps.
static inline void store_history(STORED_HISTORY texels, int index, float4 value) {
#if HISTORY_FORMAT == HALF
  vstore_half4_rte(clamp(value, -FINITE_HALF_MAX, FINITE_HALF_MAX), index, texels);
#else
  vstore4(value, index, texels);
#endif
}

// The same to the texels index to index + 3.
static inline void store_history4(STORED_HISTORY texels, int index, float16 value) {
#if HISTORY_FORMAT == HALF
  store_half_texels4(texels, index, clamp(value, -FINITE_HALF_MAX, FINITE_HALF_MAX));
#else
  vstore16(value, 0, texels + 4 * index);
#endif
}

// The first `count`.
static inline void store_history_lanes(STORED_HISTORY texels, int index, int count, LaneTexels row) {
#if LANES == 8
  if (count >= kLanes) {
    store_history4(texels, index, row.left);
    store_history4(texels, index + 4, row.right);
    return;
  }
#endif
  for (int i = 0; i < count; ++i) {
    store_history(texels, index + i, first_texel(row));
    row = push_texel(row, first_texel(row));
  }
}

// Alpha of a layer, to read: a plane of its own, one value for each texel, in the layer's format and order. It is read
// at the same places and with the same weights as colour.
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

// The values from `index` on, one a lane.
static inline LaneFloat load_alpha_lanes(AlphaPlane plane, int index) {
#if LANES == 8 && HISTORY_FORMAT == HALF
  // Through private memory: vload_half8 would want 16-byte alignment.
  const ushort8 bits = vload8(0, (__global const ushort*)plane.texels + index);
  return vload_half8(0, (__private const half*)&bits);
#elif LANES == 8
  return vload8(0, plane.texels + index);
#else
  return load_alpha(plane, index);
#endif
}

// The first `count`.
static inline void store_alpha_lanes(STORED_HISTORY texels, int index, int count, LaneFloat alpha) {
  alpha = clamp(alpha, -FINITE_HALF_MAX, FINITE_HALF_MAX);
  for (int i = 0; i < min(count, (int)kLanes); ++i) {
#if HISTORY_FORMAT == HALF
    vstore_half_rte(FIRST_LANE(alpha), index + i, texels);
#else
    texels[index + i] = FIRST_LANE(alpha);
#endif
    alpha = NEXT_LANES(alpha);
  }
}

// The four values from (x, y) on, clamped to the edge.
static inline float4 load_alpha_clamped4(AlphaPlane plane, int x, int y) {
  const int row = clamp(y, 0, plane.height - 1) * plane.width;
  const int last = plane.width - 1;
  return (float4)(load_alpha(plane, row + clamp(x, 0, last)), load_alpha(plane, row + clamp(x + 1, 0, last)),
                  load_alpha(plane, row + clamp(x + 2, 0, last)), load_alpha(plane, row + clamp(x + 3, 0, last)));
}
