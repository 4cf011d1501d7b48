// SPDX-License-Identifier: MIT
// Load and store of texels: the only place that knows buffer or image, half or float.
//
// Options, each with its default:
//   SOURCE_STORAGE   BUFFER (default) | IMAGE         of colour, velocity, depth and reactive
//   SOURCE_FORMAT    HALF (default) | FLOAT           of colour in a buffer
//   VELOCITY_FORMAT  HALF (default) | FLOAT           of velocity in a buffer
//   OUTPUT_FORMAT    FLOAT (default) | HALF           of the resolved picture, always a buffer
// An image is read without a sampler; its format is the image's own.
#pragma once

#include "params.h"

// Not zero, so that a misspelt option is an error.
#define BUFFER 1
#define IMAGE 2
#define HALF 3
#define FLOAT 4

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
#if SOURCE_FORMAT != HALF && SOURCE_FORMAT != FLOAT
#error "SOURCE_FORMAT must be HALF or FLOAT"
#endif
#if VELOCITY_FORMAT != HALF && VELOCITY_FORMAT != FLOAT
#error "VELOCITY_FORMAT must be HALF or FLOAT"
#endif
#if OUTPUT_FORMAT != HALF && OUTPUT_FORMAT != FLOAT
#error "OUTPUT_FORMAT must be HALF or FLOAT"
#endif

#if SOURCE_STORAGE == IMAGE
#define COLOUR_TEXELS read_only image2d_t
#define VELOCITY_TEXELS read_only image2d_t
#define DEPTH_TEXELS read_only image2d_t
#define REACTIVE_TEXELS read_only image2d_t
#else
#if SOURCE_FORMAT == HALF
#define COLOUR_TEXELS __global const half*
#else
#define COLOUR_TEXELS __global const float*
#endif
#if VELOCITY_FORMAT == HALF
#define VELOCITY_TEXELS __global const half*
#else
#define VELOCITY_TEXELS __global const float*
#endif
#define DEPTH_TEXELS __global const float*
#define REACTIVE_TEXELS __global const uchar*
#endif

static inline int texel_index(TexelLayout layout, int x, int y) {
  return layout.offset + y * layout.pitch + x;
}

// One colour texel.
static inline float4 load_colour(COLOUR_TEXELS texels, TexelLayout layout, int x, int y) {
#if SOURCE_STORAGE == IMAGE
  return read_imagef(texels, (int2)(x, y));
#elif SOURCE_FORMAT == HALF
  return vload_half4(texel_index(layout, x, y), texels);
#else
  return vload4(texel_index(layout, x, y), texels);
#endif
}

// The colour texels (x, y) and (x + 1, y).
static inline float8 load_colour_pair(COLOUR_TEXELS texels, TexelLayout layout, int x, int y) {
#if SOURCE_STORAGE == IMAGE
  return (float8)(read_imagef(texels, (int2)(x, y)), read_imagef(texels, (int2)(x + 1, y)));
#elif SOURCE_FORMAT == HALF
  // Through private memory: PoCL 3.1 assumes 16-byte alignment in vload_half8, and texels promise 8.
  const uint4 bits = vload4(0, (__global const uint*)(texels + 4 * texel_index(layout, x, y)));
  return vload_half8(0, (__private const half*)&bits);
#else
  return vload8(0, texels + 4 * texel_index(layout, x, y));
#endif
}

static inline float2 load_velocity(VELOCITY_TEXELS texels, TexelLayout layout, int x, int y) {
#if SOURCE_STORAGE == IMAGE
  return read_imagef(texels, (int2)(x, y)).xy;
#elif VELOCITY_FORMAT == HALF
  return vload_half2(texel_index(layout, x, y), texels);
#else
  return vload2(texel_index(layout, x, y), texels);
#endif
}

static inline float load_depth(DEPTH_TEXELS texels, TexelLayout layout, int x, int y) {
#if SOURCE_STORAGE == IMAGE
  return read_imagef(texels, (int2)(x, y)).x;
#else
  return texels[texel_index(layout, x, y)];
#endif
}

static inline float load_reactive(REACTIVE_TEXELS texels, TexelLayout layout, int x, int y) {
#if SOURCE_STORAGE == IMAGE
  return read_imagef(texels, (int2)(x, y)).x;
#else
  return (float)texels[texel_index(layout, x, y)] * (1.0f / 255.0f);
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

// The texels (x, y) to (x + 3, y); those from `count` on repeat the last.
static inline float16 load_resolved4(RESOLVED_TEXELS texels, TexelLayout layout, int x, int y, int count) {
  const int last = x + count - 1;
  return (float16)(load_resolved(texels, layout, x, y), load_resolved(texels, layout, min(x + 1, last), y),
                   load_resolved(texels, layout, min(x + 2, last), y), load_resolved(texels, layout, last, y));
}
