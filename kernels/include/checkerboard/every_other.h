// SPDX-License-Identifier: MIT
// For resolve_checkerboard: loads of texels of a row that lie two apart, one a lane, from column x on, clamped to the
// edge; and stores of twice as many.
#pragma once

#include "bits.h"
#include "resolve_params.h"
#include "stored_frame.h"

enum { kRun = 2 * kLanes };  // pixels of a row that are made at once: every other one is not shaded

// Inlines a function even where it is called twice: a call would put runs of eight into memory. Oclgrind does not know
// what clang leaves where it has inlined such a function, and is given an empty macro.
#ifndef IN_REGISTERS
#define IN_REGISTERS __attribute__((always_inline))
#endif

// Texels of a target as their bits, for those that are copied and not computed with.
#if SOURCE_STORAGE == BUFFER && SOURCE_FORMAT == HALF
typedef LaneUlong ColourBits;
#define COLOUR_WORD ulong
#elif SOURCE_STORAGE == BUFFER && SOURCE_FORMAT == SRGB8
typedef LaneUint ColourBits;
#define COLOUR_WORD uint
#else
typedef LaneTexels ColourBits;
#endif
#if SOURCE_STORAGE == BUFFER && VELOCITY_FORMAT == HALF
typedef LaneUint VelocityBits;
#define VELOCITY_WORD uint
#else
typedef LaneUlong VelocityBits;
#define VELOCITY_WORD ulong
#endif

static inline LaneInt every_other(int x) {
  return x + 2 * LANE_NUMBERS;
}

// The same, clamped to the edge.
static inline LaneInt columns_from(int x, int width) {
  return clamp(every_other(x), (LaneInt)(0), (LaneInt)(width - 1));
}

static inline bool run_is_inside(int x, int width) {
  return x >= 0 && x + kRun <= width;
}

// The word of a row in each lane's column.
#if LANES == 8
#define WORDS_AT(row, i) (row[i.s0], row[i.s1], row[i.s2], row[i.s3], row[i.s4], row[i.s5], row[i.s6], row[i.s7])
#else
#define WORDS_AT(row, i) (row[i])
#endif

static inline LaneFloat load_every_other_depth(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width) {
#if SOURCE_STORAGE == BUFFER && LANES == 8
  if (run_is_inside(x, width)) return vload16(0, texels + texel_index(layout, x, y)).even;
#endif
  return load_depth_lanes(texels, layout, columns_from(x, width), y);
}

static inline VelocityBits load_every_other_velocity(VELOCITY_TEXELS texels, TexelLayout layout, int x, int y,
                                                     int width) {
  const LaneInt i = columns_from(x, width);
#if SOURCE_STORAGE == BUFFER
  __global const VELOCITY_WORD* row = (__global const VELOCITY_WORD*)texels + row_index(layout, y);
#if LANES == 8
  if (run_is_inside(x, width)) return vload16(0, row + x).even;
#endif
  return (VelocityBits)WORDS_AT(row, i);
#elif LANES == 8
  return as_ulong8((float16)(load_velocity4(texels, layout, i.lo, y), load_velocity4(texels, layout, i.hi, y)));
#else
  return as_ulong(load_velocity(texels, layout, i, y));
#endif
}

// As codes.
static inline LaneUint load_every_other_reactive(REACTIVE_TEXELS texels, TexelLayout layout, int x, int y, int width) {
  const LaneInt i = columns_from(x, width);
#if SOURCE_STORAGE == IMAGE
  return as_lane_uint(to_lane_int(load_reactive_lanes(texels, layout, i, y) * 255.0f + 0.5f));
#else
  __global const uchar* row = texels + row_index(layout, y);
#if LANES == 8
  if (run_is_inside(x, width)) return convert_uint8(vload16(0, row + x).even);
#endif
  return (LaneUint)WORDS_AT(row, i);
#endif
}

#if SOURCE_STORAGE == IMAGE
#define STORED_TEXEL(column) read_imagef(texels, (int2)(column, y))
#elif SOURCE_FORMAT == FLOAT
#define STORED_TEXEL(column) vload4(texel_index(layout, column, y), texels)
#endif

static inline ColourBits load_every_other_colour(COLOUR_TEXELS texels, TexelLayout layout, int x, int y, int width) {
  const LaneInt i = columns_from(x, width);
#if SOURCE_STORAGE == BUFFER && SOURCE_FORMAT != FLOAT
  __global const COLOUR_WORD* row = (__global const COLOUR_WORD*)texels + row_index(layout, y);
#if LANES == 8
  if (run_is_inside(x, width)) return vload16(0, row + x).even;
#endif
  return (ColourBits)WORDS_AT(row, i);
#elif LANES == 8
  const ColourBits bits = {
      (float16)(STORED_TEXEL(i.s0), STORED_TEXEL(i.s1), STORED_TEXEL(i.s2), STORED_TEXEL(i.s3)),
      (float16)(STORED_TEXEL(i.s4), STORED_TEXEL(i.s5), STORED_TEXEL(i.s6), STORED_TEXEL(i.s7))};
  return bits;
#else
  return STORED_TEXEL(i);
#endif
}

// A group of texels is one half of the lanes, four, or the one lane there is.
#if LANES == 8
typedef float16 GroupTexels;
typedef int16 GroupChannels;
typedef float4 GroupFloats;  // one of each texel
typedef int4 GroupMask;
#define LEFT(lanes) ((lanes).lo)
#define RIGHT(lanes) ((lanes).hi)
#define LEFT_TEXELS(texels) ((texels).left)
#define RIGHT_TEXELS(texels) ((texels).right)
#define BOTH(left, right) {left, right}
#define IN_CHANNELS(values) OF_FOUR(values)  // each in all channels of its texel
#define MASK_IN_CHANNELS(mask) OF_FOUR(mask)
#else
typedef float4 GroupTexels;
typedef int4 GroupChannels;
typedef float GroupFloats;
typedef bool GroupMask;
#define LEFT(lane) (lane)
#define LEFT_TEXELS(texel) (texel)
#define BOTH(left, right) (left)
#define IN_CHANNELS(value) ((float4)(value))
#define MASK_IN_CHANNELS(mask) ((int4)((mask) ? -1 : 0))
#endif

// Linear light; of RGBA8 the codes themselves, 0 to 255.
static inline LaneTexels colours_of(ColourBits bits) {
#if SOURCE_STORAGE == IMAGE && SOURCE_FORMAT == SRGB8
  const LaneTexels colours = BOTH(rint(LEFT_TEXELS(bits) * 255.0f), rint(RIGHT_TEXELS(bits) * 255.0f));
#elif SOURCE_STORAGE == IMAGE || SOURCE_FORMAT == FLOAT
  const LaneTexels colours = bits;
#elif SOURCE_FORMAT == HALF && LANES == 8
  // Mesa 22.3 crashes on a vector of longs that is taken for halves.
  const uint16 words = as_uint16(bits);
  const uint4 w0 = words.s0123, w1 = words.s4567, w2 = words.s89ab, w3 = words.scdef;
  const LaneTexels colours = {
      (float16)(vload_half8(0, (__private const half*)&w0), vload_half8(0, (__private const half*)&w1)),
      (float16)(vload_half8(0, (__private const half*)&w2), vload_half8(0, (__private const half*)&w3))};
#elif SOURCE_FORMAT == HALF
  const uint2 words = as_uint2(bits);
  const LaneTexels colours = vload_half4(0, (__private const half*)&words);
#elif LANES == 8
  const LaneTexels colours = {convert_float16(as_uchar16(bits.lo)), convert_float16(as_uchar16(bits.hi))};
#else
  const LaneTexels colours = convert_float4(as_uchar4(bits));
#endif
  return colours;
}

// One texel as colours_of() gives it.
static inline float4 load_stored(COLOUR_TEXELS texels, TexelLayout layout, int x, int y) {
#if SOURCE_STORAGE == IMAGE && SOURCE_FORMAT == SRGB8
  return rint(read_imagef(texels, (int2)(x, y)) * 255.0f);
#elif SOURCE_STORAGE == BUFFER && SOURCE_FORMAT == SRGB8
  return convert_float4(vload4(texel_index(layout, x, y), texels));
#else
  return load_colour(texels, layout, x, y);
#endif
}

#if SOURCE_STORAGE == BUFFER && LANES == 8
// Sixteen texels of a row, the first of each two and the second.
typedef struct ColourRun {
  ColourBits even, odd;
} ColourRun;

static inline ColourRun load_colour_run(COLOUR_TEXELS texels, TexelLayout layout, int x, int y) {
  const int index = texel_index(layout, x, y);
#if SOURCE_FORMAT == FLOAT
  const float16 a = vload16(0, texels + 4 * index), b = vload16(1, texels + 4 * index);
  const float16 c = vload16(2, texels + 4 * index), d = vload16(3, texels + 4 * index);
  const ColourRun run = {{(float16)(a.s012389ab, b.s012389ab), (float16)(c.s012389ab, d.s012389ab)},
                         {(float16)(a.s4567cdef, b.s4567cdef), (float16)(c.s4567cdef, d.s4567cdef)}};
#elif SOURCE_FORMAT == HALF
  const ulong16 all = vload16(0, (__global const COLOUR_WORD*)texels + index);
  const ColourRun run = {all.even, all.odd};
#else
  const uint16 all = vload16(0, (__global const COLOUR_WORD*)texels + index);
  const ColourRun run = {all.even, all.odd};
#endif
  return run;
}
#endif

// ---- Stores of kRun neighbours of a row, from (x, y) on, that come from two runs of lanes in turn. `count` of them
// lie inside the viewport.

#if LANES == 8
// The first texel of each run, the second of each and so on.
#define IN_TURN(a, b) \
  (a.s0, b.s0, a.s1, b.s1, a.s2, b.s2, a.s3, b.s3, a.s4, b.s4, a.s5, b.s5, a.s6, b.s6, a.s7, b.s7)
#define TYPE_IN_TURN(type) type##16

// All sixteen at once, or the first `count` one by one.
#define STORE_ROW(type, row, texels)                                                 \
  if (count == kRun) {                                                               \
    vstore16(texels, 0, (__global type*)(row));                                      \
  } else {                                                                           \
    __private const type* one = (__private const type*)&texels;                      \
    for (int i = 0; i < count; ++i) ((__global type*)(row))[i] = one[i];             \
  }
#else
#define IN_TURN(a, b) (a, b)
#define TYPE_IN_TURN(type) type##2
#define STORE_ROW(type, row, texels)                                                 \
  ((__global type*)(row))[0] = (texels).s0;                                          \
  if (count > 1) ((__global type*)(row))[1] = (texels).s1;
#endif

static inline void store_depths_in_turn(STORED_DEPTH texels, TexelLayout layout, int x, int y, int count,
                                        LaneFloat even, LaneFloat odd) {
  const TYPE_IN_TURN(float) depth = (TYPE_IN_TURN(float))IN_TURN(even, odd);
#if SOURCE_STORAGE == IMAGE
  __private const float* one = (__private const float*)&depth;
  for (int i = 0; i < count; ++i) write_imagef(texels, (int2)(x + i, y), (float4)(one[i], 0.0f, 0.0f, 1.0f));
#else
  STORE_ROW(float, texels + texel_index(layout, x, y), depth)
#endif
}

static inline void store_velocities_in_turn(STORED_VELOCITY texels, TexelLayout layout, int x, int y, int count,
                                            VelocityBits even, VelocityBits odd) {
#if SOURCE_STORAGE == BUFFER && VELOCITY_FORMAT == HALF
  const TYPE_IN_TURN(uint) bits = (TYPE_IN_TURN(uint))IN_TURN(even, odd);
#else
  const TYPE_IN_TURN(ulong) bits = (TYPE_IN_TURN(ulong))IN_TURN(even, odd);
#endif
#if SOURCE_STORAGE == BUFFER
  STORE_ROW(VELOCITY_WORD, (__global VELOCITY_WORD*)texels + texel_index(layout, x, y), bits)
#else
  __private const ulong* one = (__private const ulong*)&bits;
  for (int i = 0; i < count; ++i) write_imagef(texels, (int2)(x + i, y), (float4)(as_float2(one[i]), 0.0f, 1.0f));
#endif
}

// Codes.
static inline void store_reactive_in_turn(STORED_REACTIVE texels, TexelLayout layout, int x, int y, int count,
                                          LaneUint even, LaneUint odd) {
  const TYPE_IN_TURN(uint) wide = (TYPE_IN_TURN(uint))IN_TURN(even, odd);
#if LANES == 8
  const uchar16 codes = convert_uchar16(wide);
#else
  const uchar2 codes = convert_uchar2(wide);
#endif
#if SOURCE_STORAGE == IMAGE
  __private const uchar* one = (__private const uchar*)&codes;
  for (int i = 0; i < count; ++i)
    write_imagef(texels, (int2)(x + i, y), (float4)(convert_float(one[i]) * (1.0f / 255.0f), 0.0f, 0.0f, 1.0f));
#else
  STORE_ROW(uchar, texels + texel_index(layout, x, y), codes)
#endif
}

// Returns the bits that a target holds of colours between those of finite texels. An image, whose format is unknown
// here, saturates as halves do, and an encoded one gets whole codes.
static inline ColourBits bits_of(LaneTexels colours) {
#if SOURCE_STORAGE == IMAGE && SOURCE_FORMAT == SRGB8
  const ColourBits bits =
      BOTH(rint(LEFT_TEXELS(colours)) * (1.0f / 255.0f), rint(RIGHT_TEXELS(colours)) * (1.0f / 255.0f));
#elif SOURCE_STORAGE == IMAGE
  const ColourBits bits = BOTH(clamp(LEFT_TEXELS(colours), -FINITE_HALF_MAX, FINITE_HALF_MAX),
                               clamp(RIGHT_TEXELS(colours), -FINITE_HALF_MAX, FINITE_HALF_MAX));
#elif SOURCE_FORMAT == FLOAT
  const ColourBits bits = colours;
#elif SOURCE_FORMAT == SRGB8 && LANES == 8
  const ColourBits bits = (ColourBits)(as_uint4(convert_uchar16(rint(colours.left))),
                                       as_uint4(convert_uchar16(rint(colours.right))));
#elif SOURCE_FORMAT == SRGB8
  const ColourBits bits = as_uint(convert_uchar4(rint(colours)));
#else
  ColourBits bits;
  __private half* halves = (__private half*)&bits;
#if LANES == 8
  vstore_half8_rte(colours.left.lo, 0, halves);
  vstore_half8_rte(colours.left.hi, 1, halves);
  vstore_half8_rte(colours.right.lo, 2, halves);
  vstore_half8_rte(colours.right.hi, 3, halves);
#else
  vstore_half4_rte(colours, 0, halves);
#endif
#endif
  return bits;
}

static inline void store_colours_in_turn(STORED_COLOUR texels, TexelLayout layout, int x, int y, int count,
                                         ColourBits even, ColourBits odd) {
#if SOURCE_STORAGE == BUFFER && SOURCE_FORMAT != FLOAT
#if SOURCE_FORMAT == HALF
  const TYPE_IN_TURN(ulong) bits = (TYPE_IN_TURN(ulong))IN_TURN(even, odd);
#else
  const TYPE_IN_TURN(uint) bits = (TYPE_IN_TURN(uint))IN_TURN(even, odd);
#endif
  STORE_ROW(COLOUR_WORD, (__global COLOUR_WORD*)texels + texel_index(layout, x, y), bits)
#else
  for (int i = 0; i < count; i += 2) {
    const float4 first = first_texel(even), second = first_texel(odd);
#if SOURCE_STORAGE == IMAGE
    write_imagef(texels, (int2)(x + i, y), first);
    if (i + 1 < count) write_imagef(texels, (int2)(x + i + 1, y), second);
#else
    vstore4(first, texel_index(layout, x + i, y), texels);
    if (i + 1 < count) vstore4(second, texel_index(layout, x + i + 1, y), texels);
#endif
    even = push_texel(even, first);
    odd = push_texel(odd, second);
  }
#endif
}
