// SPDX-License-Identifier: MIT
// Loads and stores of resolved pictures, which are always buffers.
#pragma once

#include "bits.h"
#include "texels/storage.h"

#if OUTPUT_FORMAT == HALF
#define OUTPUT_TEXELS __global half*
#else
#define OUTPUT_TEXELS __global float*
#endif

// Finite values only; half saturates instead of becoming infinite.
static inline void store_output(OUTPUT_TEXELS texels, TexelLayout layout, int x, int y, float4 value) {
#if OUTPUT_FORMAT == HALF
  vstore_half4(clamp(value, -FINITE_HALF_MAX, FINITE_HALF_MAX), texel_index(layout, x, y), texels);
#else
  vstore4(value, texel_index(layout, x, y), texels);
#endif
}

// kBlock neighbours of a row; with LANES=1 only p0 counts. Not an array: PoCL keeps those in memory.
typedef struct FourPixels {
  float4 p0, p1, p2, p3;
} FourPixels;

static inline int4 largest_of(int4 largest, FourPixels pixels) {
  largest = larger_magnitude(largest, pixels.p0);
  if (LANES == 1) return largest;
  return larger_magnitude(larger_magnitude(larger_magnitude(largest, pixels.p1), pixels.p2), pixels.p3);
}

// Sanitises each that counts; bit i of the result is set where pixel i was NaN or infinite.
static inline uint sanitise_four(FourPixels* pixels) {
  if (!any_reached_infinity(largest_of((int4)(0), *pixels))) return 0;
  uint bits = any_non_finite4(pixels->p0);
  pixels->p0 = sanitise4(pixels->p0);
  if (LANES == 1) return bits;
  bits |= (uint)any_non_finite4(pixels->p1) << 1 | (uint)any_non_finite4(pixels->p2) << 2 |
          (uint)any_non_finite4(pixels->p3) << 3;
  pixels->p1 = sanitise4(pixels->p1);
  pixels->p2 = sanitise4(pixels->p2);
  pixels->p3 = sanitise4(pixels->p3);
  return bits;
}

enum { kOutputAhead = 512 };  // pixels: two pages of memory

// Those of four pixels, from x on, that lie before `end`.
static inline void store_four(OUTPUT_TEXELS texels, TexelLayout layout, int x, int y, int end, FourPixels pixels) {
  WILL_WRITE(texels + 4 * (texel_index(layout, x, y) + kOutputAhead));
  store_output(texels, layout, x, y, pixels.p0);
  if (x + 3 < end) {
    store_output(texels, layout, x + 1, y, pixels.p1);
    store_output(texels, layout, x + 2, y, pixels.p2);
    store_output(texels, layout, x + 3, y, pixels.p3);
  } else {
    if (x + 1 < end) store_output(texels, layout, x + 1, y, pixels.p1);
    if (x + 2 < end) store_output(texels, layout, x + 2, y, pixels.p2);
  }
}

// A resolved picture being read back: always a buffer, in SOURCE_FORMAT.
#if SOURCE_FORMAT == HALF
#define RESOLVED_TEXELS __global const half*
#else
#define RESOLVED_TEXELS __global const float*
#endif

static inline float4 load_resolved(RESOLVED_TEXELS texels, TexelLayout layout, int x, int y) {
#if SOURCE_FORMAT == HALF
  return vload_half4(texel_index(layout, x, y), texels);
#else
  return vload4(texel_index(layout, x, y), texels);
#endif
}

// The 16 texels from `x` on, which may lie anywhere, are read soon. Worth a quarter of the time of a kernel with too
// much to compute between its loads for the processor to look far enough ahead. Halves, two lines of a cache instead of
// four, arrive in time without.
static inline void will_read_resolved16(RESOLVED_TEXELS texels, TexelLayout layout, int x, int y) {
#if SOURCE_FORMAT == FLOAT
  RESOLVED_TEXELS first = texels + 4 * texel_index(layout, x, y);
  WILL_READ(first);
  WILL_READ(first + 16);
  WILL_READ(first + 32);
  WILL_READ(first + 48);
#endif
}

// The four-channel texels index to index + 3, through private memory, as in load_colour_pair.
static inline float16 load_half_texels4(__global const half* texels, int index) {
  __global const uint* words = (__global const uint*)texels + 2 * index;
  const uint4 lower = vload4(0, words);
  const uint4 upper = vload4(1, words);
  return (float16)(vload_half8(0, (__private const half*)&lower), vload_half8(0, (__private const half*)&upper));
}

// The same of halves that are loaded already.
static inline float16 load_half_bits(ulong4 bits) {
  const ulong2 lower = bits.lo, upper = bits.hi;
  return (float16)(vload_half8(0, (__private const half*)&lower), vload_half8(0, (__private const half*)&upper));
}

// Four-channel texels at the lanes' indices.
static inline LaneTexels gather_half_texels(__global const half* texels, LaneInt index) {
#if LANES == 8
  __global const ulong* bits = (__global const ulong*)texels;
  const LaneTexels gathered = {
      load_half_bits((ulong4)(bits[index.s0], bits[index.s1], bits[index.s2], bits[index.s3])),
      load_half_bits((ulong4)(bits[index.s4], bits[index.s5], bits[index.s6], bits[index.s7]))};
  return gathered;
#else
  return vload_half4(index, texels);
#endif
}

static inline LaneTexels gather_float_texels(__global const float* texels, LaneInt index) {
#if LANES == 8
  const LaneTexels gathered = {(float16)(vload4(index.s0, texels), vload4(index.s1, texels), vload4(index.s2, texels),
                                         vload4(index.s3, texels)),
                               (float16)(vload4(index.s4, texels), vload4(index.s5, texels), vload4(index.s6, texels),
                                         vload4(index.s7, texels))};
  return gathered;
#else
  return vload4(index, texels);
#endif
}

#if SOURCE_FORMAT == HALF
#define gather_resolved(texels, index) gather_half_texels(texels, index)
#else
#define gather_resolved(texels, index) gather_float_texels(texels, index)
#endif

// The texels (x, y) to (x + 3, y).
static inline float16 load_resolved4(RESOLVED_TEXELS texels, TexelLayout layout, int x, int y) {
  const int index = texel_index(layout, x, y);
#if SOURCE_FORMAT == HALF
  return load_half_texels4(texels, index);
#else
  return vload16(0, texels + 4 * index);
#endif
}

// Neighbours of a row, one a lane, from x on, clamped to the edge.
static inline LaneTexels load_resolved_row(RESOLVED_TEXELS texels, TexelLayout layout, int x, int y, int width) {
#if LANES == 8
  if (x + kLanes <= width) {
    const LaneTexels row = {load_resolved4(texels, layout, x, y), load_resolved4(texels, layout, x + 4, y)};
    return row;
  }
#endif
  return gather_resolved(texels, texel_index(layout, 0, y) + min(x + LANE_NUMBERS, (LaneInt)(width - 1)));
}

// Rounds to the nearest.
static inline void store_half_texels4(__global half* texels, int index, float16 value) {
  uint4 lower, upper;
  vstore_half8_rte(value.lo, 0, (__private half*)&lower);
  vstore_half8_rte(value.hi, 0, (__private half*)&upper);
  __global uint* words = (__global uint*)texels + 2 * index;
  vstore4(lower, 0, words);
  vstore4(upper, 1, words);
}

// Four texels of an output, from (x, y) on; none beyond the largest half.
static inline void store_output4(OUTPUT_TEXELS texels, TexelLayout layout, int x, int y, float16 value) {
  const int index = texel_index(layout, x, y);
  WILL_WRITE(texels + 4 * (index + kOutputAhead));
#if OUTPUT_FORMAT == HALF
  store_half_texels4(texels, index, value);
#else
  vstore16(value, 0, texels + 4 * index);
#endif
}

// ---- Stores past the caches: lines of memory that are written whole need not be read first. For a picture that is
// larger than the caches, and that is read when all of it is there.

// At an address that is a multiple of 16 bytes.
#if LANES == 8 && defined(__clang__)
#define STREAM(value, address) __builtin_nontemporal_store(value, address)
#else
#define STREAM(value, address) (*(address) = (value))
#endif

// Four texels of an output, from (x, y) on. Finite values only; halves saturate, and are stored as ever.
static inline void stream_output4(OUTPUT_TEXELS texels, TexelLayout layout, int x, int y, float16 value) {
  const int index = texel_index(layout, x, y);
#if OUTPUT_FORMAT == HALF
  store_half_texels4(texels, index, clamp(value, -FINITE_HALF_MAX, FINITE_HALF_MAX));
#else
  if (((size_t)texels & 15) != 0) {  // as memory of the caller's may be
    vstore16(value, 0, texels + 4 * index);
    return;
  }
  __global float4* to = (__global float4*)texels + index;
  STREAM(value.s0123, to);
  STREAM(value.s4567, to + 1);
  STREAM(value.s89ab, to + 2);
  STREAM(value.scdef, to + 3);
#endif
}

// The first `count` pixels from (x, y) on.
static inline void stream_output_lanes(OUTPUT_TEXELS texels, TexelLayout layout, int x, int y, int count,
                                       LaneTexels pixels) {
#if LANES == 8
  if (count >= kLanes) {
    stream_output4(texels, layout, x, y, pixels.left);
    stream_output4(texels, layout, x + 4, y, pixels.right);
    return;
  }
#endif
  for (int i = 0; i < count; ++i) {
    store_output(texels, layout, x + i, y, first_texel(pixels));
    pixels = push_texel(pixels, first_texel(pixels));
  }
}
