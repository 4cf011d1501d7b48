// SPDX-License-Identifier: MIT
// Loads of what else was drawn, velocity, depth and reactive values, and stores of velocity.
#pragma once

#include "texels/storage.h"

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
