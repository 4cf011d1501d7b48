// SPDX-License-Identifier: MIT
// For resolve_checkerboard: stores of sixteen neighbours of a row, from (x, y) on, that come from two runs of eight in
// turn. `count` of them lie inside the viewport.
#pragma once

#include "checkerboard/every_other.h"

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

// What a target holds of colours that lie between those of finite texels. An image, whose format is unknown here,
// saturates as halves do, and an encoded one gets whole codes.
static inline ColourBits bits_of(EightColours colours) {
#if SOURCE_STORAGE == IMAGE && SOURCE_FORMAT == SRGB8
  const ColourBits bits = {rint(colours.first) * (1.0f / 255.0f), rint(colours.last) * (1.0f / 255.0f)};
#elif SOURCE_STORAGE == IMAGE
  const ColourBits bits = {clamp(colours.first, -INFINITY_STAND_IN, INFINITY_STAND_IN),
                           clamp(colours.last, -INFINITY_STAND_IN, INFINITY_STAND_IN)};
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
