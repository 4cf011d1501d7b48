// SPDX-License-Identifier: MIT
// Eight samples, one for each of eight pixels of a row.
#pragma once

#include "frame_samples.h"
#include "history.h"

// Of a sample that is not valid, which becomes black, nothing.
static inline float worth_or_none(float4* sample) {
  if (is_valid(*sample)) return worth_of(*sample);
  *sample = (float4)(0.0f);
  return 0.0f;
}

// What each of eight samples counts; those that are not valid become black. Returns how many of the first `count` are not finite.
static inline uint weigh_samples(EightTexels* samples, float8* weight, int count) {
  float4 sample[8];
  float worth[8];
  uint met = 0;
  vstore16(samples->left, 0, (float*)sample);
  vstore16(samples->right, 1, (float*)sample);
  for (int i = 0; i < 8; ++i) {
    if (i < count && any_non_finite4(sample[i])) met += 1;
    worth[i] = worth_or_none(&sample[i]);
  }
  samples->left = vload16(0, (const float*)sample);
  samples->right = vload16(1, (const float*)sample);
  *weight *= vload8(0, worth);
  return met;
}

static inline bool may_be_bright(EightTexels samples) {
  const int16 bits = as_int16(samples.left) | as_int16(samples.right);
  const int8 half_bits = bits.lo | bits.hi;
  return any_at_least_two(half_bits.lo | half_bits.hi);
}

// m + (s - m) part, with their confidence.
static inline float16 add_samples(float16 m, float16 s, float4 part, float4 confidence) {
  const float16 sum = m + (s - m) * to_four_texels(part);
  const int16 last = (int16)(0, 0, 0, -1, 0, 0, 0, -1, 0, 0, 0, -1, 0, 0, 0, -1);
  return select(sum, to_four_texels(confidence), last);
}
