// SPDX-License-Identifier: MIT
// The targets of a frame as a pass stores them: what texel.h loads, in the same storage and formats. Copies keep every
// bit.
#pragma once

#include "bits.h"
#include "texel.h"

#if SOURCE_STORAGE == IMAGE
#define STORED_COLOUR write_only image2d_t
#define STORED_DEPTH write_only image2d_t
#define STORED_REACTIVE write_only image2d_t
#else
#if SOURCE_FORMAT == HALF
#define STORED_COLOUR __global half*
#elif SOURCE_FORMAT == SRGB8
#define STORED_COLOUR __global uchar*
#else
#define STORED_COLOUR __global float*
#endif
#define STORED_DEPTH __global float*
#define STORED_REACTIVE __global uchar*
#endif

#if SOURCE_FORMAT != SRGB8
// Finite values only; half saturates instead of becoming infinite, and so does an image, whose format is unknown here.
static inline void store_colour(STORED_COLOUR texels, TexelLayout layout, int x, int y, float4 value) {
#if SOURCE_STORAGE == IMAGE
  write_imagef(texels, (int2)(x, y), clamp(value, -FINITE_HALF_MAX, FINITE_HALF_MAX));
#elif SOURCE_FORMAT == HALF
  vstore_half4(clamp(value, -FINITE_HALF_MAX, FINITE_HALF_MAX), texel_index(layout, x, y), texels);
#else
  vstore4(value, texel_index(layout, x, y), texels);
#endif
}

static inline void copy_colour(COLOUR_TEXELS from, TexelLayout source, STORED_COLOUR to, TexelLayout layout, int x,
                               int y) {
#if SOURCE_STORAGE == IMAGE
  write_imagef(to, (int2)(x, y), read_imagef(from, (int2)(x, y)));
#elif SOURCE_FORMAT == HALF
  ((__global uint2*)to)[texel_index(layout, x, y)] = ((__global const uint2*)from)[texel_index(source, x, y)];
#else
  vstore4(vload4(texel_index(source, x, y), (__global const uint*)from), texel_index(layout, x, y), (__global uint*)to);
#endif
}
#endif

// From texel (x, y) to texel (to_x, to_y).
static inline void copy_reactive(REACTIVE_TEXELS from, TexelLayout source, int x, int y, STORED_REACTIVE to,
                                 TexelLayout layout, int to_x, int to_y) {
#if SOURCE_STORAGE == IMAGE
  write_imagef(to, (int2)(to_x, to_y), read_imagef(from, (int2)(x, y)));
#else
  to[texel_index(layout, to_x, to_y)] = from[texel_index(source, x, y)];
#endif
}

// A value in [0, 1], rounded to the nearest code. For an image here, too: left to itself a device may be off by 0.6
// codes (1.2, 8.3.1.2).
static inline void store_reactive(STORED_REACTIVE texels, TexelLayout layout, int x, int y, float value) {
#if SOURCE_STORAGE == IMAGE
  write_imagef(texels, (int2)(x, y), (float4)(rint(value * 255.0f) * (1.0f / 255.0f), 0.0f, 0.0f, 1.0f));
#else
  texels[texel_index(layout, x, y)] = convert_uchar_sat_rte(value * 255.0f);
#endif
}
