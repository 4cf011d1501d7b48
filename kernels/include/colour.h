// SPDX-License-Identifier: MIT
// Tone curves and the sRGB encoding, 16 values at a time.
#pragma once

#include "sanitise.h"

#define TONE_CLAMP 1
#define TONE_REINHARD 2
#define TONE_ACES 3

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
  x = clamp(x, 0.0f, INFINITY_STAND_IN);
#if TONE_MAP == TONE_REINHARD
  return x / (1.0f + x);
#else
  // Narkowicz, "ACES Filmic Tone Mapping Curve", 2015.
  return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f);
#endif
#endif
}
