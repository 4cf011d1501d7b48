// SPDX-License-Identifier: MIT
// present: exposure, tone map, sRGB encoding to 8 bits.
//   params      in   extents, layouts, exposure (> 0, multiplies linear colour)
//   source      in   RGBA32F or RGBA16F, output extent, linear, premultiplied; a buffer
//   exposure    in   a float that multiplies params.exposure, as long as it is positive and finite
//   output      out  RGBA8 buffer or image of the output extent: sRGB colour, alpha linear; the layout of an image
//                    counts rows, so that they can be turned
//   non_finite  out  non_finite[params.counter] grows by the pixels that are NaN or infinite; they count as 0, +-65504
// Options: TONE_MAP        TONE_ACES (default) | TONE_REINHARD | TONE_CLAMP
//          DITHER          1 (default): colour rounds up or down by a fixed pattern of the position | 0: to nearest
//          SOURCE_FORMAT   HALF (default) | FLOAT
//          OUTPUT_STORAGE  BUFFER (default) | IMAGE
// The code is exact to 0.004 before rounding. A colour that is a whole code keeps it under dither.
// Source: dither pattern R2 after Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018.
// Reference: tests/reference/present.cpp
#define TONE_CLAMP 1
#define TONE_REINHARD 2
#define TONE_ACES 3
#ifndef TONE_MAP
#define TONE_MAP TONE_ACES
#endif
#ifndef DITHER
#define DITHER 1
#endif
#ifndef OUTPUT_STORAGE
#define OUTPUT_STORAGE BUFFER
#endif
#include "bits.h"
#include "picture_params.h"
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

enum { kPrefetchDistance = 256 };  // pixels: one page of memory, which is where the processor itself stops

// 255 * the sRGB encoding of x in [0, 1.05], plus `offset`: 255 * 1.055 * x^(1/2.4) - 255 * 0.055 but for the linear
// part. Error below 0.004 code values: 0.001 from the polynomial of log2 and 0.0006 from its rounding, 0.0015 from the
// power, the rest rounding. Both polynomials are minimax fits. The bits of x, read as an integer, are 2^23 (log2 x +
// 127) but for what depends on the mantissa alone. The power is taken as the fourth power of
// 2^(5/48 log2 x + log2(255 * 1.055) / 4): no root, no division, and no second split into exponent and mantissa.
static inline float16 srgb_code(float16 x, float16 offset) {
  const int16 bits = as_int16(x);
  const float16 m = as_float16((bits & 0x007fffff) | 0x3f800000);
  // log2 x + 128.800364, times 2^23.
  float16 log2_x = (0.04487361013889313f * 0x1p23f) * m + (-0.4165636897087097f * 0x1p23f);
  log2_x = log2_x * m + (1.6311488151550293f * 0x1p23f);
  log2_x = log2_x * m + (-3.550792932510376f * 0x1p23f);
  log2_x = log2_x * m + ((5.091711044311523f - 1.0f) * 0x1p23f);
  log2_x = log2_x * m + convert_float16(bits);
  const float16 quarter =
      log2_x * (5.0f / 48.0f * 0x1p-23f) + (2.017899108947830f - 128.8003640174865723f * 5.0f / 48.0f);
  // 2^quarter on [1.15, 2.03].
  float16 root = 0.028843291103839874f * quarter + -0.015382448211312294f;
  root = root * quarter + 0.3591001331806183f;
  root = root * quarter + 0.597632646560669f;
  root = root * quarter + 1.0299022197723389f;
  const float16 square = root * root;
  const float16 curve = square * square + (offset - 255.0f * 0.055f);
  return select(curve, x * (255.0f * 12.92f) + offset, x <= 0.0031308f);
}

// From linear light, any finite value, to [0, 1.05]; what exceeds 1 exceeds the largest code too.
static inline float16 tone_map(float16 x) {
#if TONE_MAP == TONE_CLAMP
  return clamp(x, 0.0f, 1.0f);
#else
  x = clamp(x, 0.0f, FINITE_HALF_MAX);
#if TONE_MAP == TONE_REINHARD
  return x / (1.0f + x);
#else
  // Narkowicz, "ACES Filmic Tone Mapping Curve", 2015.
  return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f);
#endif
#endif
}

// Four registers of four pixels become a register a channel, so that no work is spent on alpha. One channel of 16
// pixels, in this order: the first of each four, then the second, third and fourth.
#define PLANE_ORDER (uint16)(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15)
typedef struct Planes {
  float16 red, green, blue, alpha;
} Planes;

// Returns the first, or last, two values of each four of a and b in turn: one instruction where four floats are a
// register's lane.
static inline float16 first_pairs(float16 a, float16 b) {
  return (float16)(a.s0, b.s0, a.s1, b.s1, a.s4, b.s4, a.s5, b.s5, a.s8, b.s8, a.s9, b.s9, a.sc, b.sc, a.sd, b.sd);
}
static inline float16 last_pairs(float16 a, float16 b) {
  return (float16)(a.s2, b.s2, a.s3, b.s3, a.s6, b.s6, a.s7, b.s7, a.sa, b.sa, a.sb, b.sb, a.se, b.se, a.sf, b.sf);
}
static inline float16 lower_halves(float16 a, float16 b) {
  return (float16)(a.s0, a.s1, b.s0, b.s1, a.s4, a.s5, b.s4, b.s5, a.s8, a.s9, b.s8, b.s9, a.sc, a.sd, b.sc, b.sd);
}
static inline float16 upper_halves(float16 a, float16 b) {
  return (float16)(a.s2, a.s3, b.s2, b.s3, a.s6, a.s7, b.s6, b.s7, a.sa, a.sb, b.sa, b.sb, a.se, a.sf, b.se, b.sf);
}

// From four times four pixels.
static inline Planes planes_of(float16 a, float16 b, float16 c, float16 d) {
  const float16 ab01 = first_pairs(a, b), cd01 = first_pairs(c, d);
  const float16 ab23 = last_pairs(a, b), cd23 = last_pairs(c, d);
  const Planes planes = {lower_halves(ab01, cd01), upper_halves(ab01, cd01), lower_halves(ab23, cd23),
                         upper_halves(ab23, cd23)};
  return planes;
}

// Returns the offset of a code before truncation, in [0, 1): 0.5 rounds to nearest, as alpha always does.
static inline float16 rounding(int x, int y) {
#if DITHER
  // x / g + y / g^2 modulo 1, g the plastic number 1.3247..., in units of 2^-32.
  const uint16 phase = PLANE_ORDER * 3242174889u + ((uint)x * 3242174889u + (uint)y * 2447445414u);
  return convert_float16(as_int16(phase >> 8)) * 0x1p-24f;
#else
  return 0.5f;
#endif
}

static inline uint16 encode_plane(float16 colour, float exposure, float16 round) {
  return as_uint16(convert_int16(fmin(srgb_code(tone_map(colour * exposure), round), 255.0f)));
}

// The codes of the 16 pixels from x on. Inline, so that its constants stay in registers throughout a row.
__attribute__((always_inline)) static inline uint16 encode(float16 a, float16 b, float16 c, float16 d, float exposure,
                                                           int x, int y) {
  const Planes planes = planes_of(a, b, c, d);
  const float16 round = rounding(x, y);
  const uint16 red = encode_plane(planes.red, exposure, round);
  const uint16 green = encode_plane(planes.green, exposure, round);
  const uint16 blue = encode_plane(planes.blue, exposure, round);
  const uint16 alpha = as_uint16(convert_int16(clamp(planes.alpha, 0.0f, 1.0f) * 255.0f + 0.5f));
  const uint16 codes = red | green << 8 | blue << 16 | alpha << 24;
  return codes.s048c159d26ae37bf;
}

// Four pixels from x on, of which those before `end` exist.
static inline void store_four_codes(PRESENTED_TEXELS texels, TexelLayout layout, int x, int y, int end, uint4 codes) {
#if OUTPUT_STORAGE == IMAGE
  const float16 values = convert_float16(as_uchar16(codes)) * (1.0f / 255.0f);
  const int row = row_index(layout, y);
  write_imagef(texels, (int2)(x, row), values.s0123);
  if (x + 1 < end) write_imagef(texels, (int2)(x + 1, row), values.s4567);
  if (x + 2 < end) write_imagef(texels, (int2)(x + 2, row), values.s89ab);
  if (x + 3 < end) write_imagef(texels, (int2)(x + 3, row), values.scdef);
#else
  __global uint* pixels = texels + texel_index(layout, x, y);
  if (x + 3 < end) {
    vstore4(codes, 0, pixels);
    return;
  }
  pixels[0] = codes.s0;
  if (x + 1 < end) pixels[1] = codes.s1;
  if (x + 2 < end) pixels[2] = codes.s2;
#endif
}

static inline void store_codes(PRESENTED_TEXELS texels, TexelLayout layout, int x, int y, uint16 codes) {
#if OUTPUT_STORAGE == IMAGE
  const int end = x + kPresentBlock;
  store_four_codes(texels, layout, x, y, end, codes.s0123);
  store_four_codes(texels, layout, x + 4, y, end, codes.s4567);
  store_four_codes(texels, layout, x + 8, y, end, codes.s89ab);
  store_four_codes(texels, layout, x + 12, y, end, codes.scdef);
#else
  vstore16(codes, 0, texels + texel_index(layout, x, y));
#endif
}

static inline int16 magnitude(float16 value) {
  return as_int16(value) & 0x7fffffff;
}

// One pixel of any value; sets bit `bit` of *met where it is NaN or infinite.
static inline float4 load_careful(RESOLVED_TEXELS source, TexelLayout layout, int x, int y, uint bit, uint* met) {
  const float4 colour = load_resolved(source, layout, x, y);
  if (any_non_finite4(colour)) *met |= bit;
  return sanitise4(colour);
}

__kernel void present(const PresentParams params, RESOLVED_TEXELS source, __global const float* exposure,
                      PRESENTED_TEXELS output, __global uint* non_finite) {
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(params.columns_per_item, params.width, kPresentBlock);
  if (item.first >= item.end || y >= params.height) return;

  const float given = *exposure;
  const float factor = params.exposure * (given > 0.0f && given <= FLT_MAX ? given : 1.0f);
  int x = item.first;
#if LANES == 8
  int16 largest = 0;
  for (; x + kPresentBlock <= item.end; x += kPresentBlock) {
    const float16 a = load_resolved4(source, params.source, x, y);
    const float16 b = load_resolved4(source, params.source, x + 4, y);
    const float16 c = load_resolved4(source, params.source, x + 8, y);
    const float16 d = load_resolved4(source, params.source, x + 12, y);
    will_read_resolved16(source, params.source, x + kPrefetchDistance, y);
    largest = max(max(largest, magnitude(a)), max(max(magnitude(b), magnitude(c)), magnitude(d)));
    store_codes(output, params.output, x, y, encode(a, b, c, d, factor, x, y));
  }
  const int8 largest8 = max(largest.lo, largest.hi);
  if (any_reached_infinity(max(largest8.lo, largest8.hi))) x = item.first;
#endif

  // The rest of the row or, which is rare, all of it once more: pixel by pixel, four of them in each register. With
  // LANES=1 all of it, one by one.
  uint met_count = 0;
  for (; x < item.end; x += LANES == 8 ? kBlock : item.step) {
    uint met = 0;
    const int count = pixels_from(item, x), last = x + count - 1;
    const float4 p0 = load_careful(source, params.source, x, y, 1, &met);
    const float4 p1 = load_careful(source, params.source, min(x + 1, last), y, 2, &met);
    const float4 p2 = load_careful(source, params.source, min(x + 2, last), y, 4, &met);
    const float4 p3 = load_careful(source, params.source, min(x + 3, last), y, 8, &met);
    met_count += count_bits(met, count);
    const float16 colour = (float16)(p0, p1, p2, p3);
    const uint16 codes = encode(colour, colour, colour, colour, factor, x, y);
    store_four_codes(output, params.output, x, y, x + count, codes.s0123);
  }
  if (met_count) atomic_add(non_finite + params.counter, met_count);
}
