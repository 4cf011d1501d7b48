// SPDX-License-Identifier: MIT
// Load and store of texels: the only place that knows buffer or image, half or float.
//
// Options, each with its default:
//   SOURCE_STORAGE   BUFFER (default) | IMAGE         of colour, velocity, depth and reactive
//   SOURCE_FORMAT    HALF (default) | FLOAT | SRGB8   of colour in a buffer; SRGB8 of colour in an image, too
//   VELOCITY_FORMAT  HALF (default) | FLOAT           of velocity in a buffer
//   OUTPUT_FORMAT    FLOAT (default) | HALF           of the resolved picture, always a buffer
// An image is read without a sampler; its format is the image's own. SRGB8 is RGBA8 whose colour is sRGB encoded: every
// load gives linear light.
#pragma once

#include "params.h"
#include "sanitise.h"
#include "srgb.h"

// Not zero, so that a misspelt option is an error.
#define BUFFER 1
#define IMAGE 2
#define HALF 3
#define FLOAT 4
#define SRGB8 5

#ifndef SOURCE_STORAGE
#define SOURCE_STORAGE BUFFER
#endif
#ifndef SOURCE_FORMAT
#define SOURCE_FORMAT HALF
#endif
#ifndef VELOCITY_FORMAT
#define VELOCITY_FORMAT HALF
#endif
#ifndef OUTPUT_FORMAT
#define OUTPUT_FORMAT FLOAT
#endif
#if SOURCE_STORAGE != BUFFER && SOURCE_STORAGE != IMAGE
#error "SOURCE_STORAGE must be BUFFER or IMAGE"
#endif
#if SOURCE_FORMAT != HALF && SOURCE_FORMAT != FLOAT && SOURCE_FORMAT != SRGB8
#error "SOURCE_FORMAT must be HALF, FLOAT or SRGB8"
#endif
#if VELOCITY_FORMAT != HALF && VELOCITY_FORMAT != FLOAT
#error "VELOCITY_FORMAT must be HALF or FLOAT"
#endif
#if OUTPUT_FORMAT != HALF && OUTPUT_FORMAT != FLOAT
#error "OUTPUT_FORMAT must be HALF or FLOAT"
#endif

// Mesa 25.0 (rusticl) loses an image that is the argument of a function that branches: reads crash its compiler, writes
// vanish. OpenCL C allows such functions (1.2, 6.9 b). With this attribute clang, which runs first, inlines them. PoCL
// has a macro of its own.
#if (SOURCE_STORAGE == IMAGE || (defined(OUTPUT_STORAGE) && OUTPUT_STORAGE == IMAGE)) && !defined(inline)
#define inline inline __attribute__((always_inline))
#endif

#if SOURCE_STORAGE == IMAGE
#define COLOUR_TEXELS read_only image2d_t
#define VELOCITY_TEXELS read_only image2d_t
#define DEPTH_TEXELS read_only image2d_t
#define REACTIVE_TEXELS read_only image2d_t
#define STORED_VELOCITY write_only image2d_t
#else
#if SOURCE_FORMAT == HALF
#define COLOUR_TEXELS __global const half*
#elif SOURCE_FORMAT == SRGB8
#define COLOUR_TEXELS __global const uchar*
#else
#define COLOUR_TEXELS __global const float*
#endif
#if VELOCITY_FORMAT == HALF
#define VELOCITY_TEXELS __global const half*
#define STORED_VELOCITY __global half*
#else
#define VELOCITY_TEXELS __global const float*
#define STORED_VELOCITY __global float*
#endif
#define DEPTH_TEXELS __global const float*
#define REACTIVE_TEXELS __global const uchar*
#endif

// Hints for a CPU that memory is used soon; any address will do. The processor itself stops at the end of a page of
// memory. PoCL's prefetch() does nothing, and a GPU hides latency by other means.
#if defined(__x86_64__) || defined(__aarch64__)
#define WILL_READ(address) __builtin_prefetch(address)
#define WILL_WRITE(address) __builtin_prefetch(address, 1)
#else
#define WILL_READ(address) ((void)(address))
#define WILL_WRITE(address) ((void)(address))
#endif

// Of texel (0, y).
static inline int row_index(TexelLayout layout, int y) {
  return layout.offset + y * layout.pitch;
}

static inline int texel_index(TexelLayout layout, int x, int y) {
  return row_index(layout, y) + x;
}

#if SOURCE_STORAGE == IMAGE
static inline float4 read_colour(COLOUR_TEXELS texels, int x, int y) {
#if SOURCE_FORMAT == SRGB8
  return linear_of_fractions(read_imagef(texels, (int2)(x, y)));
#else
  return read_imagef(texels, (int2)(x, y));
#endif
}
#endif

// One colour texel.
static inline float4 load_colour(COLOUR_TEXELS texels, TexelLayout layout, int x, int y) {
#if SOURCE_STORAGE == IMAGE
  return read_colour(texels, x, y);
#elif SOURCE_FORMAT == HALF
  return vload_half4(texel_index(layout, x, y), texels);
#elif SOURCE_FORMAT == SRGB8
  return linear_of_codes(vload4(texel_index(layout, x, y), texels));
#else
  return vload4(texel_index(layout, x, y), texels);
#endif
}

// The texels around (x, y), which may lie anywhere, are read soon.
static inline void will_read_colour(COLOUR_TEXELS texels, TexelLayout layout, int x, int y) {
#if SOURCE_STORAGE == BUFFER
  WILL_READ(texels + 4 * texel_index(layout, x, y));
#endif
}

// A row of colour to read pairs from.
#if SOURCE_STORAGE == IMAGE
#define COLOUR_ROW int
#elif SOURCE_FORMAT == HALF
#define COLOUR_ROW __global const uint2*
#elif SOURCE_FORMAT == SRGB8
#define COLOUR_ROW __global const uint*
#else
#define COLOUR_ROW __global const float4*
#endif

static inline COLOUR_ROW colour_row(COLOUR_TEXELS texels, TexelLayout layout, int y) {
#if SOURCE_STORAGE == IMAGE
  return y;
#else
  return (COLOUR_ROW)texels + row_index(layout, y);
#endif
}

// The colour texels x and x + 1 of a row.
static inline float8 load_colour_pair(COLOUR_TEXELS texels, COLOUR_ROW row, uint x) {
#if SOURCE_STORAGE == IMAGE
  return (float8)(read_colour(texels, x, row), read_colour(texels, x + 1, row));
#elif SOURCE_FORMAT == HALF
  // Through private memory: PoCL 3.1 assumes 16-byte alignment in vload_half8, and texels promise 8.
  const uint4 bits = vload4(0, (__global const uint*)(row + x));
  return vload_half8(0, (__private const half*)&bits);
#elif SOURCE_FORMAT == SRGB8
  return (float8)(linear_of_codes(as_uchar4(row[x])), linear_of_codes(as_uchar4(row[x + 1])));
#else
  return vload8(0, (__global const float*)(row + x));
#endif
}

// The colour texels (x, y) and (x + 1, y), which `index` = y * pitch + x of a buffer's first row gives as well; an
// image has no index.
static inline float8 load_colour_pair_at(COLOUR_TEXELS texels, COLOUR_ROW first_row, int index, int x, int y) {
#if SOURCE_STORAGE == IMAGE
  return load_colour_pair(texels, y, x);
#else
  return load_colour_pair(texels, first_row, index);
#endif
}

// The colour texels x to x + 3 of a row.
static inline float16 load_colour4(COLOUR_TEXELS texels, COLOUR_ROW row, uint x) {
  return (float16)(load_colour_pair(texels, row, x), load_colour_pair(texels, row, x + 2));
}

// The velocities of four texels of one row, x and y in turn.
static inline float8 load_velocity4(VELOCITY_TEXELS texels, TexelLayout layout, int4 x, int y) {
#if SOURCE_STORAGE == IMAGE
  return (float8)(read_imagef(texels, (int2)(x.s0, y)).xy, read_imagef(texels, (int2)(x.s1, y)).xy,
                  read_imagef(texels, (int2)(x.s2, y)).xy, read_imagef(texels, (int2)(x.s3, y)).xy);
#else
  const int row = row_index(layout, y);
#if VELOCITY_FORMAT == HALF
  __global const uint* pairs = (__global const uint*)texels + row;
  const uint4 bits = (uint4)(pairs[x.s0], pairs[x.s1], pairs[x.s2], pairs[x.s3]);
  return vload_half8(0, (__private const half*)&bits);
#else
  return (float8)(vload2(row + x.s0, texels), vload2(row + x.s1, texels), vload2(row + x.s2, texels),
                  vload2(row + x.s3, texels));
#endif
#endif
}

// The velocity of one texel.
static inline float2 load_velocity(VELOCITY_TEXELS texels, TexelLayout layout, int x, int y) {
#if SOURCE_STORAGE == IMAGE
  return read_imagef(texels, (int2)(x, y)).xy;
#elif VELOCITY_FORMAT == HALF
  return vload_half2(texel_index(layout, x, y), texels);
#else
  return vload2(texel_index(layout, x, y), texels);
#endif
}

// The velocities of those of four texels, from x on, that lie before `end`; x and y in turn.
static inline void store_velocity4(STORED_VELOCITY texels, TexelLayout layout, int x, int y, int end, float8 velocity) {
#if SOURCE_STORAGE == IMAGE
  write_imagef(texels, (int2)(x, y), (float4)(velocity.s01, 0.0f, 1.0f));
  if (x + 1 < end) write_imagef(texels, (int2)(x + 1, y), (float4)(velocity.s23, 0.0f, 1.0f));
  if (x + 2 < end) write_imagef(texels, (int2)(x + 2, y), (float4)(velocity.s45, 0.0f, 1.0f));
  if (x + 3 < end) write_imagef(texels, (int2)(x + 3, y), (float4)(velocity.s67, 0.0f, 1.0f));
#else
#if VELOCITY_FORMAT == HALF
  __global uint* pairs = (__global uint*)texels + texel_index(layout, x, y);
  uint4 bits;
  vstore_half8(velocity, 0, (__private half*)&bits);
#else
  __global ulong* pairs = (__global ulong*)texels + texel_index(layout, x, y);
  const ulong4 bits = as_ulong4(velocity);
#endif
  if (x + 3 < end) {
    vstore4(bits, 0, pairs);
    return;
  }
  pairs[0] = bits.s0;
  if (x + 1 < end) pairs[1] = bits.s1;
  if (x + 2 < end) pairs[2] = bits.s2;
#endif
}

static inline float load_depth(DEPTH_TEXELS texels, TexelLayout layout, int x, int y) {
#if SOURCE_STORAGE == IMAGE
  return read_imagef(texels, (int2)(x, y)).x;
#else
  return texels[texel_index(layout, x, y)];
#endif
}

static inline float4 load_depth4(DEPTH_TEXELS texels, TexelLayout layout, int4 x, int y) {
#if SOURCE_STORAGE == IMAGE
  return (float4)(read_imagef(texels, (int2)(x.s0, y)).x, read_imagef(texels, (int2)(x.s1, y)).x,
                  read_imagef(texels, (int2)(x.s2, y)).x, read_imagef(texels, (int2)(x.s3, y)).x);
#else
  __global const float* row = texels + row_index(layout, y);
  return (float4)(row[x.s0], row[x.s1], row[x.s2], row[x.s3]);
#endif
}

// The depths of four neighbours of a row, from x on, clamped to the edge.
static inline float4 load_depth_block(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width) {
#if SOURCE_STORAGE == BUFFER
  if (x + 3 < width) return vload4(0, texels + texel_index(layout, x, y));
#endif
  return load_depth4(texels, layout, min(x + (int4)(0, 1, 2, 3), (int4)(width - 1)), y);
}

static inline float4 load_reactive4(REACTIVE_TEXELS texels, TexelLayout layout, int4 x, int y) {
#if SOURCE_STORAGE == IMAGE
  return (float4)(read_imagef(texels, (int2)(x.s0, y)).x, read_imagef(texels, (int2)(x.s1, y)).x,
                  read_imagef(texels, (int2)(x.s2, y)).x, read_imagef(texels, (int2)(x.s3, y)).x);
#else
  __global const uchar* row = texels + row_index(layout, y);
  return convert_float4((int4)(row[x.s0], row[x.s1], row[x.s2], row[x.s3])) * (1.0f / 255.0f);
#endif
}

#if OUTPUT_FORMAT == HALF
#define OUTPUT_TEXELS __global half*
#else
#define OUTPUT_TEXELS __global float*
#endif

// Finite values only; half saturates instead of becoming infinite.
static inline void store_output(OUTPUT_TEXELS texels, TexelLayout layout, int x, int y, float4 value) {
#if OUTPUT_FORMAT == HALF
  vstore_half4(clamp(value, -65504.0f, 65504.0f), texel_index(layout, x, y), texels);
#else
  vstore4(value, texel_index(layout, x, y), texels);
#endif
}

// kBlock neighbours of a row. Not an array: PoCL keeps those in memory.
typedef struct FourPixels {
  float4 p0, p1, p2, p3;
} FourPixels;

static inline int4 largest_of(int4 largest, FourPixels pixels) {
  largest = larger_magnitude(larger_magnitude(largest, pixels.p0), pixels.p1);
  return larger_magnitude(larger_magnitude(largest, pixels.p2), pixels.p3);
}

// Sanitises each; bit i of the result is set where pixel i was NaN or infinite.
static inline uint sanitise_four(FourPixels* pixels) {
  if (!any_reached_infinity(largest_of((int4)(0), *pixels))) return 0;
  const uint bits = (uint)any_non_finite4(pixels->p0) | (uint)any_non_finite4(pixels->p1) << 1 |
                    (uint)any_non_finite4(pixels->p2) << 2 | (uint)any_non_finite4(pixels->p3) << 3;
  pixels->p0 = sanitise4(pixels->p0);
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

// The texels (x, y) to (x + 3, y).
static inline float16 load_resolved4(RESOLVED_TEXELS texels, TexelLayout layout, int x, int y) {
  const int index = texel_index(layout, x, y);
#if SOURCE_FORMAT == HALF
  return load_half_texels4(texels, index);
#else
  return vload16(0, texels + 4 * index);
#endif
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
