// SPDX-License-Identifier: MIT
// present: exposure, tone map, sRGB encoding to 8 bits.
//   params      in   extents, layouts, exposure (> 0, multiplies linear colour)
//   source      in   RGBA32F or RGBA16F, output extent, linear, premultiplied; a buffer
//   output      out  RGBA8 buffer or image of the output extent: sRGB colour, alpha linear
//   non_finite  out  non_finite[params.counter] grows by the pixels that are NaN or infinite; they count as 0, +-65504
// Options: TONE_MAP        TONE_ACES (default) | TONE_REINHARD | TONE_CLAMP
//          DITHER          1 (default): colour rounds up or down by a fixed pattern of the position | 0: to nearest
//          SOURCE_FORMAT   HALF (default) | FLOAT
//          OUTPUT_STORAGE  BUFFER (default) | IMAGE
// The code is exact to 0.002 before rounding. A colour that is a whole code keeps it under dither.
// Source: dither pattern R2 after Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018.
// Reference: tests/reference/present.cpp
#ifndef TONE_MAP
#define TONE_MAP TONE_ACES
#endif
#ifndef DITHER
#define DITHER 1
#endif
#ifndef OUTPUT_STORAGE
#define OUTPUT_STORAGE BUFFER
#endif
#include "colour.h"
#include "sanitise.h"
#include "texel.h"
#if TONE_MAP != TONE_CLAMP && TONE_MAP != TONE_REINHARD && TONE_MAP != TONE_ACES
#error "TONE_MAP must be TONE_CLAMP, TONE_REINHARD or TONE_ACES"
#endif
#if DITHER != 0 && DITHER != 1
#error "DITHER must be 0 or 1"
#endif
#if OUTPUT_STORAGE == IMAGE
#define PRESENTED_TEXELS write_only image2d_t
#elif OUTPUT_STORAGE == BUFFER
#define PRESENTED_TEXELS __global uchar* restrict
#else
#error "OUTPUT_STORAGE must be BUFFER or IMAGE"
#endif



// In [0, 1): what is added before truncation. 0.5 rounds to nearest.
static inline float4 rounding(int x, int y) {
#if DITHER
  // x / g + y / g^2 modulo 1, g the plastic number 1.3247..., in units of 2^-32.
  const uint4 phase = ((uint4)((uint)x) + (uint4)(0, 1, 2, 3)) * 3242174889u + (uint)y * 2447445414u;
  return convert_float4(phase >> 8) * 0x1p-24f;
#else
  return 0.5f;
#endif
}

static inline uchar16 encode(float16 linear_colour, float exposure, float4 round) {
  const float16 encoded = srgb_code(tone_map(linear_colour * exposure));
  const float4 alpha = clamp(linear_colour.s37bf, 0.0f, 1.0f) * 255.0f + 0.5f;
  float16 code = fmin(encoded + round.s0000111122223333, 255.0f);
  code.s37bf = alpha;
  return convert_uchar16(convert_int16(code));
}

// Up to four pixels from x on.
static inline void store_codes(PRESENTED_TEXELS texels, TexelLayout layout, int x, int y, int count, uchar16 codes) {
#if OUTPUT_STORAGE == IMAGE
  const float16 values = convert_float16(codes) * (1.0f / 255.0f);
  write_imagef(texels, (int2)(x, y), values.s0123);
  if (count > 1) write_imagef(texels, (int2)(x + 1, y), values.s4567);
  if (count > 2) write_imagef(texels, (int2)(x + 2, y), values.s89ab);
  if (count > 3) write_imagef(texels, (int2)(x + 3, y), values.scdef);
#else
  const int index = texel_index(layout, x, y);
  if (count == kBlock) {
    vstore16(codes, 0, texels + 4 * index);
    return;
  }
  vstore4(codes.s0123, index, texels);
  if (count > 1) vstore4(codes.s4567, index + 1, texels);
  if (count > 2) vstore4(codes.s89ab, index + 2, texels);
#endif
}

__kernel void present(const PresentParams params, RESOLVED_TEXELS source, PRESENTED_TEXELS output,
                      __global uint* restrict non_finite) {
  const int y = get_global_id(1);
  const int first = get_global_id(0) * params.columns_per_item;
  if (first >= params.width || y >= params.height) return;

  const int end = min(first + params.columns_per_item, params.width);
  for (int x = first; x < end; x += kBlock) {
    const int count = min(kBlock, params.width - x);
    float16 colour = load_resolved4(source, params.source, x, y, count);
    if (any((as_int16(colour) & 0x7fffffff) >= NON_FINITE_BITS)) {
      const uint met = (uint)any_non_finite4(colour.s0123) + (count > 1 && any_non_finite4(colour.s4567)) +
                       (count > 2 && any_non_finite4(colour.s89ab)) + (count > 3 && any_non_finite4(colour.scdef));
      colour = (float16)(sanitise4(colour.s0123), sanitise4(colour.s4567), sanitise4(colour.s89ab),
                         sanitise4(colour.scdef));
      atomic_add(non_finite + params.counter, met);
    }
    store_codes(output, params.output, x, y, count, encode(colour, params.exposure, rounding(x, y)));
  }
}
