// SPDX-License-Identifier: MIT
// Tone curves and the sRGB encoding, 16 values at a time: four pixels of four channels.
#pragma once

#define TONE_CLAMP 1
#define TONE_REINHARD 2
#define TONE_ACES 3

// 255 * the sRGB encoding of x in [0, 1]. Error below 0.002 code values: 5e-4 from the logarithm, 7e-4 from the power,
// the rest rounding. Both polynomials are minimax fits. As x^(1/2.4) = 2^(5/12 log2 x) it costs neither root nor
// division.
static inline float16 srgb_code(float16 x) {
  // x = 2^exponent * (1 + t), t in [sqrt(1/2) - 1, sqrt(2) - 1].
  const int16 exponent = (as_int16(x) - 0x3f3504f3) >> 23;
  const float16 t = as_float16(as_int16(x) - (exponent << 23)) - 1.0f;
  float16 log2_x = -0.29807236790657043f * t + 0.3613906800746918f;
  log2_x = log2_x * t + -0.35763975977897644f;
  log2_x = log2_x * t + 0.47498607635498047f;
  log2_x = log2_x * t + -0.721367359161377f;
  log2_x = log2_x * t + 1.4428094625473022f;
  log2_x = log2_x * t + convert_float16(exponent);
  // log2(255 * 1.055) = 8.0715955; never below 4.6 on the curved part, so truncation is floor there.
  const float16 power = fmax(log2_x * (5.0f / 12.0f) + 8.0715955f, 0.0f);
  const int16 whole = convert_int16(power);
  const float16 part = power - convert_float16(whole);
  float16 curve = 0.013534167781472206f * part + 0.052011460065841675f;
  curve = curve * part + 0.2414427548646927f;
  curve = curve * part + 0.6930038332939148f;
  curve = curve * part + 1.0000026226043701f;
  curve = as_float16(as_int16(curve) + (whole << 23)) - 255.0f * 0.055f;
  return select(curve, x * (255.0f * 12.92f), x <= 0.0031308f);
}

// From linear light, any finite value, to [0, 1].
static inline float16 tone_map(float16 x) {
  x = clamp(x, 0.0f, 65504.0f);
#if TONE_MAP == TONE_REINHARD
  return x / (1.0f + x);
#elif TONE_MAP == TONE_ACES
  // Narkowicz, "ACES Filmic Tone Mapping Curve", 2015.
  return fmin(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 1.0f);
#else
  return fmin(x, 1.0f);
#endif
}
