// SPDX-License-Identifier: MIT
// Loads of velocity, depth and reactive values, and stores of velocity.
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

// The depths of a row's texels, one a lane.
static inline LaneFloat load_depth_lanes(DEPTH_TEXELS texels, TexelLayout layout, LaneInt x, int y) {
#if LANES == 8
  return (LaneFloat)(load_depth4(texels, layout, x.lo, y), load_depth4(texels, layout, x.hi, y));
#else
  return load_depth(texels, layout, x, y);
#endif
}

static inline float load_reactive(REACTIVE_TEXELS texels, TexelLayout layout, int x, int y) {
#if SOURCE_STORAGE == IMAGE
  return read_imagef(texels, (int2)(x, y)).x;
#else
  const float code = convert_float(texels[texel_index(layout, x, y)]);
  return FRACTION_OF_CODE(code);
#endif
}

static inline float4 load_reactive4(REACTIVE_TEXELS texels, TexelLayout layout, int4 x, int y) {
#if SOURCE_STORAGE == IMAGE
  return (float4)(read_imagef(texels, (int2)(x.s0, y)).x, read_imagef(texels, (int2)(x.s1, y)).x,
                  read_imagef(texels, (int2)(x.s2, y)).x, read_imagef(texels, (int2)(x.s3, y)).x);
#else
  __global const uchar* row = texels + row_index(layout, y);
  const float4 codes = convert_float4((int4)(row[x.s0], row[x.s1], row[x.s2], row[x.s3]));
  return FRACTION_OF_CODE(codes);
#endif
}

// The same, one a lane.
static inline LaneFloat load_reactive_lanes(REACTIVE_TEXELS texels, TexelLayout layout, LaneInt x, int y) {
#if LANES == 8
  return (LaneFloat)(load_reactive4(texels, layout, x.lo, y), load_reactive4(texels, layout, x.hi, y));
#else
  return load_reactive(texels, layout, x, y);
#endif
}

// The columns x to x + 3 of a viewport `width` wide, clamped to its edge.
static inline int4 block_columns(int x, int width) {
  return clamp(x + (int4)(0, 1, 2, 3), (int4)(0), (int4)(width - 1));
}

// The velocities of four neighbours of a row, from x on, which may be -1; x and y in turn.
static inline float8 load_velocity_block(VELOCITY_TEXELS texels, TexelLayout layout, int x, int y, int width) {
#if SOURCE_STORAGE == BUFFER
  if (x >= 0 && x + 3 < width) {
#if VELOCITY_FORMAT == HALF
    // Through private memory: vload_half8 would want 16-byte alignment.
    const uint4 bits = vload4(0, (__global const uint*)texels + texel_index(layout, x, y));
    return vload_half8(0, (__private const half*)&bits);
#else
    return vload8(0, texels + 2 * texel_index(layout, x, y));
#endif
  }
#endif
  return load_velocity4(texels, layout, block_columns(x, width), y);
}

// The velocities of four texels anywhere.
static inline float8 load_velocity_at(VELOCITY_TEXELS texels, TexelLayout layout, int4 x, int4 y) {
#if SOURCE_STORAGE == IMAGE
  return (float8)(read_imagef(texels, (int2)(x.s0, y.s0)).xy, read_imagef(texels, (int2)(x.s1, y.s1)).xy,
                  read_imagef(texels, (int2)(x.s2, y.s2)).xy, read_imagef(texels, (int2)(x.s3, y.s3)).xy);
#else
  const int4 index = layout.offset + y * layout.pitch + x;
#if VELOCITY_FORMAT == HALF
  __global const uint* pairs = (__global const uint*)texels;
  const uint4 bits = (uint4)(pairs[index.s0], pairs[index.s1], pairs[index.s2], pairs[index.s3]);
  return vload_half8(0, (__private const half*)&bits);
#else
  return (float8)(vload2(index.s0, texels), vload2(index.s1, texels), vload2(index.s2, texels),
                  vload2(index.s3, texels));
#endif
#endif
}

// The depths of four texels anywhere.
static inline float4 load_depth_at(DEPTH_TEXELS texels, TexelLayout layout, int4 x, int4 y) {
#if SOURCE_STORAGE == IMAGE
  return (float4)(read_imagef(texels, (int2)(x.s0, y.s0)).x, read_imagef(texels, (int2)(x.s1, y.s1)).x,
                  read_imagef(texels, (int2)(x.s2, y.s2)).x, read_imagef(texels, (int2)(x.s3, y.s3)).x);
#else
  const int4 index = layout.offset + y * layout.pitch + x;
  return (float4)(texels[index.s0], texels[index.s1], texels[index.s2], texels[index.s3]);
#endif
}

// The smallest and the largest depths of four 2x2 blocks.
typedef struct DepthRange {
  float4 least, most;
} DepthRange;

static inline DepthRange range_of_rows(float4 upper_left, float4 upper_right, float4 lower_left, float4 lower_right) {
  const DepthRange range = {fmin(fmin(upper_left, upper_right), fmin(lower_left, lower_right)),
                            fmax(fmax(upper_left, upper_right), fmax(lower_left, lower_right))};
  return range;
}

// Returns the ranges of depth of the blocks that begin at (x, y), in a viewport of two texels or more on both sides. A
// NaN does not count.
static inline DepthRange depth_ranges(DEPTH_TEXELS texels, TexelLayout layout, int4 x, int4 y, int width) {
#if SOURCE_STORAGE == BUFFER
  // Where surfaces are wider than a block and nothing scales the four lie side by side. One lane asks for one of them.
  const long2 apart = as_long2((x - (x.s0 + (int4)(0, 1, 2, 3))) | (y - y.s0));
  if (LANES == 8 && (apart.x | apart.y) == 0 && x.s0 + 4 < width) {
    __global const float* upper = texels + texel_index(layout, x.s0, y.s0);
    __global const float* lower = upper + layout.pitch;
    return range_of_rows(vload4(0, upper), vload4(0, upper + 1), vload4(0, lower), vload4(0, lower + 1));
  }
  const int4 upper = layout.offset + y * layout.pitch + x;
  const int4 lower = upper + layout.pitch;
  const float2 u0 = vload2(0, texels + upper.s0), u1 = vload2(0, texels + upper.s1);
  const float2 u2 = vload2(0, texels + upper.s2), u3 = vload2(0, texels + upper.s3);
  const float2 l0 = vload2(0, texels + lower.s0), l1 = vload2(0, texels + lower.s1);
  const float2 l2 = vload2(0, texels + lower.s2), l3 = vload2(0, texels + lower.s3);
  return range_of_rows((float4)(u0.x, u1.x, u2.x, u3.x), (float4)(u0.y, u1.y, u2.y, u3.y),
                       (float4)(l0.x, l1.x, l2.x, l3.x), (float4)(l0.y, l1.y, l2.y, l3.y));
#else
  return range_of_rows(load_depth_at(texels, layout, x, y), load_depth_at(texels, layout, x + 1, y),
                       load_depth_at(texels, layout, x, y + 1), load_depth_at(texels, layout, x + 1, y + 1));
#endif
}

// The reactive values of four texels anywhere.
static inline float4 load_reactive_at(REACTIVE_TEXELS texels, TexelLayout layout, int4 x, int4 y) {
#if SOURCE_STORAGE == IMAGE
  return (float4)(read_imagef(texels, (int2)(x.s0, y.s0)).x, read_imagef(texels, (int2)(x.s1, y.s1)).x,
                  read_imagef(texels, (int2)(x.s2, y.s2)).x, read_imagef(texels, (int2)(x.s3, y.s3)).x);
#else
  const int4 index = layout.offset + y * layout.pitch + x;
  const float4 codes = convert_float4((int4)(texels[index.s0], texels[index.s1], texels[index.s2], texels[index.s3]));
  return FRACTION_OF_CODE(codes);
#endif
}

// The reactive values of four neighbours of a row, from x on, which may be -1.
static inline float4 load_reactive_block(REACTIVE_TEXELS texels, TexelLayout layout, int x, int y, int width) {
#if SOURCE_STORAGE == BUFFER
  if (x >= 0 && x + 3 < width) {
    const float4 codes = convert_float4(vload4(0, texels + texel_index(layout, x, y)));
    return FRACTION_OF_CODE(codes);
  }
#endif
  return load_reactive4(texels, layout, block_columns(x, width), y);
}
