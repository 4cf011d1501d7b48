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

// The depths of neighbours of a row, one a lane, from x on, clamped to the edge.
static inline LaneFloat load_depth_row(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width) {
#if LANES == 8
  return (LaneFloat)(load_depth_block(texels, layout, x, y, width), load_depth_block(texels, layout, x + 4, y, width));
#else
  return load_depth(texels, layout, min(x, width - 1), y);
#endif
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

// The velocities of neighbours of a row, one a lane, from x on, which may be -1, clamped to the edge.
static inline LaneFloat2 load_velocity_row(VELOCITY_TEXELS texels, TexelLayout layout, int x, int y, int width) {
#if LANES == 8
  const float8 left = load_velocity_block(texels, layout, x, y, width);
  const float8 right = load_velocity_block(texels, layout, x + 4, y, width);
  const LaneFloat2 row = {(LaneFloat)(left.even, right.even), (LaneFloat)(left.odd, right.odd)};
#else
  const float2 own = load_velocity(texels, layout, clamp(x, 0, width - 1), y);
  const LaneFloat2 row = {own.x, own.y};
#endif
  return row;
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

// The velocities of texels anywhere, one a lane.
static inline LaneFloat2 load_velocities_at(VELOCITY_TEXELS texels, TexelLayout layout, LaneInt x, LaneInt y) {
#if LANES == 8
  const float8 left = load_velocity_at(texels, layout, x.lo, y.lo);
  const float8 right = load_velocity_at(texels, layout, x.hi, y.hi);
  const LaneFloat2 found = {(LaneFloat)(left.even, right.even), (LaneFloat)(left.odd, right.odd)};
#else
  const float2 own = load_velocity(texels, layout, x, y);
  const LaneFloat2 found = {own.x, own.y};
#endif
  return found;
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

// The same, one a lane.
static inline LaneFloat load_depths_at(DEPTH_TEXELS texels, TexelLayout layout, LaneInt x, LaneInt y) {
#if LANES == 8
  return (LaneFloat)(load_depth_at(texels, layout, x.lo, y.lo), load_depth_at(texels, layout, x.hi, y.hi));
#else
  return load_depth(texels, layout, x, y);
#endif
}

// The smallest and the largest depths of 2x2 blocks.
typedef struct DepthRanges {
  LaneFloat least, most;
} DepthRanges;

// A NaN does not count.
static inline DepthRanges ranges_of_rows(LaneFloat upper_left, LaneFloat upper_right, LaneFloat lower_left,
                                         LaneFloat lower_right) {
  const DepthRanges ranges = {fmin(fmin(upper_left, upper_right), fmin(lower_left, lower_right)),
                              fmax(fmax(upper_left, upper_right), fmax(lower_left, lower_right))};
  return ranges;
}

#if LANES == 8 && SOURCE_STORAGE == BUFFER
// The depths of eight texels and of their right neighbours, in turns.
static inline float16 load_depth_pairs(DEPTH_TEXELS texels, LaneInt index) {
  return (float16)(vload2(0, texels + index.s0), vload2(0, texels + index.s1), vload2(0, texels + index.s2),
                   vload2(0, texels + index.s3), vload2(0, texels + index.s4), vload2(0, texels + index.s5),
                   vload2(0, texels + index.s6), vload2(0, texels + index.s7));
}
#endif

// Returns the ranges of depth of the blocks that begin at (x, y), in a viewport of two texels or more on both sides.
static inline DepthRanges depth_ranges(DEPTH_TEXELS texels, TexelLayout layout, LaneInt x, LaneInt y, int width) {
#if SOURCE_STORAGE == IMAGE
  return ranges_of_rows(load_depths_at(texels, layout, x, y), load_depths_at(texels, layout, x + 1, y),
                        load_depths_at(texels, layout, x, y + 1), load_depths_at(texels, layout, x + 1, y + 1));
#elif LANES == 8
  const LaneInt index = layout.offset + y * layout.pitch + x;
  // Where surfaces are wider than a block and nothing scales they lie side by side.
  if (!any_lane((x - (x.s0 + LANE_NUMBERS)) | (y - y.s0)) && x.s0 + kLanes < width) {
    __global const float* upper = texels + index.s0;
    __global const float* lower = upper + layout.pitch;
    return ranges_of_rows(vload8(0, upper), vload8(0, upper + 1), vload8(0, lower), vload8(0, lower + 1));
  }
  const float16 upper = load_depth_pairs(texels, index), lower = load_depth_pairs(texels, index + layout.pitch);
  return ranges_of_rows(upper.even, upper.odd, lower.even, lower.odd);
#else
  const int index = texel_index(layout, x, y);
  const float2 upper = vload2(0, texels + index), lower = vload2(0, texels + index + layout.pitch);
  return ranges_of_rows(upper.x, upper.y, lower.x, lower.y);
#endif
}

// The reactive values of texels anywhere, one a lane.
static inline LaneFloat load_reactives_at(REACTIVE_TEXELS texels, TexelLayout layout, LaneInt x, LaneInt y) {
#if LANES == 1
  return load_reactive(texels, layout, x, y);
#elif SOURCE_STORAGE == IMAGE
  LaneFloat values = (LaneFloat)(0.0f);
  for (int i = 0; i < kLanes; ++i) {
    FIRST_LANE(values) = load_reactive(texels, layout, FIRST_LANE(x), FIRST_LANE(y));
    values = NEXT_LANES(values);
    x = NEXT_LANES(x);
    y = NEXT_LANES(y);
  }
  return values;
#else
  const LaneInt at = layout.offset + y * layout.pitch + x;
  const LaneFloat codes = convert_float8((uchar8)(texels[at.s0], texels[at.s1], texels[at.s2], texels[at.s3],
                                                  texels[at.s4], texels[at.s5], texels[at.s6], texels[at.s7]));
  return FRACTION_OF_CODE(codes);
#endif
}

// The reactive values of neighbours of a row, one a lane, from x on, which may be -1, clamped to the edge.
static inline LaneFloat load_reactive_row(REACTIVE_TEXELS texels, TexelLayout layout, int x, int y, int width) {
#if SOURCE_STORAGE == BUFFER && LANES == 8
  if (x >= 0 && x + kLanes <= width) {
    const LaneFloat codes = convert_float8(vload8(0, texels + texel_index(layout, x, y)));
    return FRACTION_OF_CODE(codes);
  }
#endif
  return load_reactive_lanes(texels, layout, clamp(x + LANE_NUMBERS, (LaneInt)(0), (LaneInt)(width - 1)), y);
}
