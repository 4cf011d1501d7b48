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
// The code is exact to 0.003 before rounding. A colour that is a whole code keeps it under dither.
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
#define PRESENTED_TEXELS __global uint*
#else
#error "OUTPUT_STORAGE must be BUFFER or IMAGE"
#endif



// What is added to four pixels before truncation, in [0, 1): 0.5 rounds to nearest, as alpha always does.
static inline float16 rounding(int x, int y) {
#if DITHER
  // x / g + y / g^2 modulo 1, g the plastic number 1.3247..., in units of 2^-32.
  const uint16 pixel = (uint16)(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3) * 3242174889u;
  const uint16 phase = pixel + ((uint)x * 3242174889u + (uint)y * 2447445414u);
  return convert_float16(as_int16(phase >> 8)) * 0x1p-24f;
#else
  return 0.5f;
#endif
}

static inline uchar16 encode(float16 colour, float exposure, float16 round) {
  const int16 is_alpha = (int16)(0, 0, 0, -1, 0, 0, 0, -1, 0, 0, 0, -1, 0, 0, 0, -1);
  const float16 code = srgb_code(tone_map(colour * exposure)) + round;
  const float16 alpha = clamp(colour, 0.0f, 1.0f) * 255.0f + 0.5f;
  return convert_uchar16(convert_int16(fmin(select(code, alpha, is_alpha), 255.0f)));
}

// Four pixels from x on, of which those before `end` exist.
static inline void store_codes(PRESENTED_TEXELS texels, TexelLayout layout, int x, int y, int end, uchar16 codes) {
#if OUTPUT_STORAGE == IMAGE
  const float16 values = convert_float16(codes) * (1.0f / 255.0f);
  write_imagef(texels, (int2)(x, y), values.s0123);
  if (x + 1 < end) write_imagef(texels, (int2)(x + 1, y), values.s4567);
  if (x + 2 < end) write_imagef(texels, (int2)(x + 2, y), values.s89ab);
  if (x + 3 < end) write_imagef(texels, (int2)(x + 3, y), values.scdef);
#else
  __global uint* pixels = texels + texel_index(layout, x, y);
  const uint4 packed = as_uint4(codes);
  if (x + 3 < end) {
    vstore4(packed, 0, pixels);
    return;
  }
  pixels[0] = packed.s0;
  if (x + 1 < end) pixels[1] = packed.s1;
  if (x + 2 < end) pixels[2] = packed.s2;
#endif
}

// One pixel of any value; sets bit `bit` of *met where it is NaN or infinite.
static inline float4 load_careful(RESOLVED_TEXELS source, TexelLayout layout, int x, int y, uint bit, uint* met) {
  const float4 colour = load_resolved(source, layout, x, y);
  if (any_non_finite4(colour)) *met |= bit;
  return sanitise4(colour);
}

__kernel void present(const PresentParams params, RESOLVED_TEXELS source, PRESENTED_TEXELS output,
                      __global uint* non_finite) {
  const int y = get_global_id(1);
  const int first = get_global_id(0) * params.columns_per_item;
  if (first >= params.width || y >= params.height) return;

  const int end = min(first + params.columns_per_item, params.width);
  int16 largest = 0;
  int x = first;
  for (; x + kBlock <= end; x += kBlock) {
    const float16 colour = load_resolved4(source, params.source, x, y);
    largest = max(largest, as_int16(colour) & 0x7fffffff);
    store_codes(output, params.output, x, y, end, encode(colour, params.exposure, rounding(x, y)));
  }
  const int8 largest8 = max(largest.lo, largest.hi);
  if (any_reached_infinity(max(largest8.lo, largest8.hi))) x = first;

  // What is left over of the row or, which is rare, all of it once more: pixel by pixel.
  uint met_count = 0;
  for (; x < end; x += kBlock) {
    uint met = 0;
    const int last = end - 1;
    const float4 p0 = load_careful(source, params.source, x, y, 1, &met);
    const float4 p1 = load_careful(source, params.source, min(x + 1, last), y, 2, &met);
    const float4 p2 = load_careful(source, params.source, min(x + 2, last), y, 4, &met);
    const float4 p3 = load_careful(source, params.source, min(x + 3, last), y, 8, &met);
    met_count += count_bits(met, end - x);
    const float16 colour = (float16)(p0, p1, p2, p3);
    store_codes(output, params.output, x, y, end, encode(colour, params.exposure, rounding(x, y)));
  }
  if (met_count) atomic_add(non_finite + params.counter, met_count);
}
