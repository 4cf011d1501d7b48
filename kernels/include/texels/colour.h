// SPDX-License-Identifier: MIT
// Loads of the colour that was drawn.
#pragma once

#include "srgb.h"
#include "texels/storage.h"

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
