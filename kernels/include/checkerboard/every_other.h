// SPDX-License-Identifier: MIT
// For resolve_checkerboard: eight texels of a row that lie two apart, from column x on, clamped to the edge.
#pragma once

#include "checkerboard/checkerboard_params.h"
#include "stored_frame.h"

// Of what is called twice, too: a call would put runs of eight into memory. Oclgrind does not know what clang leaves
// where it has inlined such a function, and is given an empty macro.
#ifndef IN_REGISTERS
#define IN_REGISTERS __attribute__((always_inline))
#endif

// What of a target is copied, not computed with, stays as its bits.
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
  if (run_is_inside(x, width)) return vload16(0, texels + texel_index(layout, x, y)).even;
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
  if (run_is_inside(x, width)) return vload16(0, row + x).even;
  return (uint8)(row[i.s0], row[i.s1], row[i.s2], row[i.s3], row[i.s4], row[i.s5], row[i.s6], row[i.s7]);
#else
  __global const ulong* row = (__global const ulong*)texels + row_index(layout, y);
  if (run_is_inside(x, width)) return vload16(0, row + x).even;
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
  if (run_is_inside(x, width)) return convert_uint8(vload16(0, row + x).even);
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
  if (run_is_inside(x, width)) return vload16(0, row + x).even;
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
