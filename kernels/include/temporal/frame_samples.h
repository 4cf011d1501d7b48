// SPDX-License-Identifier: MIT
// The samples of this frame, one at a time or one for each of eight pixels. Those that are not finite, or as large as
// a half can be, are invalid and take no part.
#pragma once

#include "temporal/history.h"
#include "texel.h"

#define INVALID_BITS 0x477fe000  // of 65504, the largest half: what a half target holds of anything brighter

static inline bool is_valid(float4 sample) {
  const long2 hits = as_long2((as_int4(sample) & 0x7fffffff) >= INVALID_BITS);
  return (hits.x | hits.y) == 0;
}

// To each channel of four samples whether that sample is.
static inline int16 are_valid(float16 samples) {
  const int16 magnitude = as_int16(samples) & 0x7fffffff;
  const int16 pairs = max(magnitude, magnitude.s1032547698badcfe);
  return max(pairs, pairs.s23016745ab89efcd) < INVALID_BITS;
}

static inline float largest_colour(float4 colour) {
  return max(max(colour.x, colour.y), max(colour.z, 0.0f));
}

// Clamped to the viewport's edge.
static inline float4 sample_at(COLOUR_TEXELS texels, const SourceFrame* frame, int x, int y) {
  return load_colour(texels, frame->colour, clamp(x, 0, frame->width - 1), clamp(y, 0, frame->height - 1));
}

// The samples of a row nearest to eight pixels.
static inline EightTexels load_samples(COLOUR_TEXELS texels, TexelLayout layout, int8 x, int y) {
#if SOURCE_STORAGE == BUFFER && SOURCE_FORMAT == HALF
  __global const ulong* row = (__global const ulong*)texels + row_index(layout, y);
  const EightTexels samples = {load_half_bits((ulong4)(row[x.s0], row[x.s1], row[x.s2], row[x.s3])),
                               load_half_bits((ulong4)(row[x.s4], row[x.s5], row[x.s6], row[x.s7]))};
  return samples;
#else
  return eight_texels(load_colour(texels, layout, x.s0, y), load_colour(texels, layout, x.s1, y),
                      load_colour(texels, layout, x.s2, y), load_colour(texels, layout, x.s3, y),
                      load_colour(texels, layout, x.s4, y), load_colour(texels, layout, x.s5, y),
                      load_colour(texels, layout, x.s6, y), load_colour(texels, layout, x.s7, y));
#endif
}

// The luma weight of a valid sample: 1 up to a brightest channel of 2 and less beyond, so that one bright sample does
// not outshine the others. (Worth .65 dB over the laboratory's sequences, 3.6 on sparkles: docs/temporal.md.)
static inline float luma_weight(float4 sample) {
  return 1.0f / max(1.0f, 0.5f * largest_colour(sample));
}
