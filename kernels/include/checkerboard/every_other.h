// SPDX-License-Identifier: MIT
// For resolve_checkerboard: loads of eight texels of a row that lie two apart, from column x on, clamped to the edge,
// and stores of sixteen.
#pragma once

#include "bits.h"
#include "resolve_params.h"
#include "stored_frame.h"

// Inlines a function even where it is called twice: a call would put runs of eight into memory. Oclgrind does not know
// what clang leaves where it has inlined such a function, and is given an empty macro.
#ifndef IN_REGISTERS
#define IN_REGISTERS __attribute__((always_inline))
#endif

// Texels of a target as their bits, for those that are copied and not computed with.
#if SOURCE_STORAGE == BUFFER && SOURCE_FORMAT == HALF
typedef ulong8 ColourBits;
#define COLOUR_WORDS __global const ulong*
#elif SOURCE_STORAGE == BUFFER && SOURCE_FORMAT == SRGB8
typedef uint8 ColourBits;
#define COLOUR_WORDS __global const uint*
#else
typedef struct ColourBits {
  float16 first, last;
} ColourBits;
#endif
#if SOURCE_STORAGE == BUFFER && VELOCITY_FORMAT == HALF
typedef uint8 VelocityBits;
#else
typedef ulong8 VelocityBits;
#endif

// The colours of eight pixels, four and four. Linear light; of RGBA8 the codes themselves, 0 to 255.
typedef struct EightColours {
  float16 first, last;
} EightColours;

static inline int8 every_other(int x) {
  return x + (int8)(0, 2, 4, 6, 8, 10, 12, 14);
}

static inline bool run_is_inside(int x, int width) {
  return x >= 0 && x + kCheckerboardBlock <= width;
}

static inline float8 load_every_other_depth(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width) {
#if SOURCE_STORAGE == BUFFER
  if (LANES == 8 && run_is_inside(x, width)) return vload16(0, texels + texel_index(layout, x, y)).even;
#endif
  const int8 column = clamp(every_other(x), (int8)(0), (int8)(width - 1));
  return (float8)(load_depth4(texels, layout, column.lo, y), load_depth4(texels, layout, column.hi, y));
}

static inline VelocityBits load_every_other_velocity(VELOCITY_TEXELS texels, TexelLayout layout, int x, int y,
                                                     int width) {
  const int8 i = clamp(every_other(x), (int8)(0), (int8)(width - 1));
#if SOURCE_STORAGE == IMAGE
  return as_ulong8((float16)(load_velocity4(texels, layout, i.lo, y), load_velocity4(texels, layout, i.hi, y)));
#elif VELOCITY_FORMAT == HALF
  __global const uint* row = (__global const uint*)texels + row_index(layout, y);
  if (LANES == 8 && run_is_inside(x, width)) return vload16(0, row + x).even;
  return (uint8)(row[i.s0], row[i.s1], row[i.s2], row[i.s3], row[i.s4], row[i.s5], row[i.s6], row[i.s7]);
#else
  __global const ulong* row = (__global const ulong*)texels + row_index(layout, y);
  if (LANES == 8 && run_is_inside(x, width)) return vload16(0, row + x).even;
  return (ulong8)(row[i.s0], row[i.s1], row[i.s2], row[i.s3], row[i.s4], row[i.s5], row[i.s6], row[i.s7]);
#endif
}

// As codes.
static inline uint8 load_every_other_reactive(REACTIVE_TEXELS texels, TexelLayout layout, int x, int y, int width) {
  const int8 i = clamp(every_other(x), (int8)(0), (int8)(width - 1));
#if SOURCE_STORAGE == IMAGE
  const float8 values = (float8)(load_reactive4(texels, layout, i.lo, y), load_reactive4(texels, layout, i.hi, y));
  return convert_uint8(values * 255.0f + 0.5f);
#else
  __global const uchar* row = texels + row_index(layout, y);
  if (LANES == 8 && run_is_inside(x, width)) return convert_uint8(vload16(0, row + x).even);
  return (uint8)(row[i.s0], row[i.s1], row[i.s2], row[i.s3], row[i.s4], row[i.s5], row[i.s6], row[i.s7]);
#endif
}

#if SOURCE_STORAGE == IMAGE
#define STORED_TEXEL(column) read_imagef(texels, (int2)(column, y))
#elif SOURCE_FORMAT == FLOAT
#define STORED_TEXEL(column) vload4(texel_index(layout, column, y), texels)
#endif

static inline ColourBits load_every_other_colour(COLOUR_TEXELS texels, TexelLayout layout, int x, int y, int width) {
  const int8 i = clamp(every_other(x), (int8)(0), (int8)(width - 1));
#if SOURCE_STORAGE == IMAGE || SOURCE_FORMAT == FLOAT
  const ColourBits bits = {
      (float16)(STORED_TEXEL(i.s0), STORED_TEXEL(i.s1), STORED_TEXEL(i.s2), STORED_TEXEL(i.s3)),
      (float16)(STORED_TEXEL(i.s4), STORED_TEXEL(i.s5), STORED_TEXEL(i.s6), STORED_TEXEL(i.s7))};
  return bits;
#else
  COLOUR_WORDS row = (COLOUR_WORDS)texels + row_index(layout, y);
  if (LANES == 8 && run_is_inside(x, width)) return vload16(0, row + x).even;
  return (ColourBits)(row[i.s0], row[i.s1], row[i.s2], row[i.s3], row[i.s4], row[i.s5], row[i.s6], row[i.s7]);
#endif
}

static inline EightColours colours_of(ColourBits bits) {
#if SOURCE_STORAGE == IMAGE && SOURCE_FORMAT == SRGB8
  const EightColours colours = {rint(bits.first * 255.0f), rint(bits.last * 255.0f)};
#elif SOURCE_STORAGE == IMAGE || SOURCE_FORMAT == FLOAT
  const EightColours colours = {bits.first, bits.last};
#elif SOURCE_FORMAT == HALF
  // Mesa 22.3 crashes on a vector of longs that is taken for halves.
  const uint16 words = as_uint16(bits);
  const uint4 w0 = words.s0123, w1 = words.s4567, w2 = words.s89ab, w3 = words.scdef;
  const EightColours colours = {
      (float16)(vload_half8(0, (__private const half*)&w0), vload_half8(0, (__private const half*)&w1)),
      (float16)(vload_half8(0, (__private const half*)&w2), vload_half8(0, (__private const half*)&w3))};
#else
  const EightColours colours = {convert_float16(as_uchar16(bits.lo)), convert_float16(as_uchar16(bits.hi))};
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

#if SOURCE_STORAGE == BUFFER
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
  const ulong16 all = vload16(0, (COLOUR_WORDS)texels + index);
  const ColourRun run = {all.even, all.odd};
#else
  const uint16 all = vload16(0, (COLOUR_WORDS)texels + index);
  const ColourRun run = {all.even, all.odd};
#endif
  return run;
}
#endif

// ---- Stores of sixteen neighbours of a row, from (x, y) on, that come from two runs of eight in turn. `count` of them
// lie inside the viewport.

// The first texel of each run, the second of each and so on.
#define IN_TURN(a, b) \
  (a.s0, b.s0, a.s1, b.s1, a.s2, b.s2, a.s3, b.s3, a.s4, b.s4, a.s5, b.s5, a.s6, b.s6, a.s7, b.s7)

// All sixteen at once, or the first `count` one by one.
#define STORE_ROW(type, row, texels)                                                 \
  if (count == kCheckerboardBlock) {                                                 \
    vstore16(texels, 0, (__global type*)(row));                                      \
  } else {                                                                           \
    __private const type* one = (__private const type*)&texels;                      \
    for (int i = 0; i < count; ++i) ((__global type*)(row))[i] = one[i];             \
  }

static inline void store_depths_in_turn(STORED_DEPTH texels, TexelLayout layout, int x, int y, int count, float8 even,
                                        float8 odd) {
  const float16 depth = (float16)IN_TURN(even, odd);
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
  const uint16 bits = (uint16)IN_TURN(even, odd);
  STORE_ROW(uint, (__global uint*)texels + texel_index(layout, x, y), bits)
#else
  const ulong16 bits = (ulong16)IN_TURN(even, odd);
#if SOURCE_STORAGE == BUFFER
  STORE_ROW(ulong, (__global ulong*)texels + texel_index(layout, x, y), bits)
#else
  __private const ulong* one = (__private const ulong*)&bits;
  for (int i = 0; i < count; ++i) write_imagef(texels, (int2)(x + i, y), (float4)(as_float2(one[i]), 0.0f, 1.0f));
#endif
#endif
}

// Codes.
static inline void store_reactive_in_turn(STORED_REACTIVE texels, TexelLayout layout, int x, int y, int count,
                                          uint8 even, uint8 odd) {
  const uchar16 codes = convert_uchar16((uint16)IN_TURN(even, odd));
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
static inline ColourBits bits_of(EightColours colours) {
#if SOURCE_STORAGE == IMAGE && SOURCE_FORMAT == SRGB8
  const ColourBits bits = {rint(colours.first) * (1.0f / 255.0f), rint(colours.last) * (1.0f / 255.0f)};
#elif SOURCE_STORAGE == IMAGE
  const ColourBits bits = {clamp(colours.first, -FINITE_HALF_MAX, FINITE_HALF_MAX),
                           clamp(colours.last, -FINITE_HALF_MAX, FINITE_HALF_MAX)};
#elif SOURCE_FORMAT == FLOAT
  const ColourBits bits = {colours.first, colours.last};
#elif SOURCE_FORMAT == SRGB8
  const ColourBits bits = (ColourBits)(as_uint4(convert_uchar16(rint(colours.first))),
                                       as_uint4(convert_uchar16(rint(colours.last))));
#else
  ColourBits bits;
  __private half* halves = (__private half*)&bits;
  vstore_half8_rte(colours.first.lo, 0, halves);
  vstore_half8_rte(colours.first.hi, 1, halves);
  vstore_half8_rte(colours.last.lo, 2, halves);
  vstore_half8_rte(colours.last.hi, 3, halves);
#endif
  return bits;
}

static inline void store_colours_in_turn(STORED_COLOUR texels, TexelLayout layout, int x, int y, int count,
                                         ColourBits even, ColourBits odd) {
#if SOURCE_STORAGE == IMAGE || SOURCE_FORMAT == FLOAT
  const float4 all[kCheckerboardBlock] = {
      even.first.s0123, odd.first.s0123, even.first.s4567, odd.first.s4567, even.first.s89ab, odd.first.s89ab,
      even.first.scdef, odd.first.scdef, even.last.s0123,  odd.last.s0123,  even.last.s4567,  odd.last.s4567,
      even.last.s89ab,  odd.last.s89ab,  even.last.scdef,  odd.last.scdef};
  for (int i = 0; i < count; ++i) {
#if SOURCE_STORAGE == IMAGE
    write_imagef(texels, (int2)(x + i, y), all[i]);
#else
    vstore4(all[i], texel_index(layout, x + i, y), texels);
#endif
  }
#elif SOURCE_FORMAT == HALF
  const ulong16 bits = (ulong16)IN_TURN(even, odd);
  STORE_ROW(ulong, (__global ulong*)texels + texel_index(layout, x, y), bits)
#else
  const uint16 bits = (uint16)IN_TURN(even, odd);
  STORE_ROW(uint, (__global uint*)texels + texel_index(layout, x, y), bits)
#endif
}
