// SPDX-License-Identifier: MIT
// Smoothing of what is shown of little confidence: eight output pixels of a row at a time. +.1 dB (docs/temporal.md).
//
// Option: SMOOTH  1 (default) | 0
#pragma once

#include "temporal/bell.h"
#include "temporal/history_sampling.h"

#ifndef SMOOTH
#define SMOOTH 1
#endif
#if SMOOTH < 0 || SMOOTH > 1
#error "SMOOTH must be 0 or 1"
#endif

// Found by search on the development scenes.
#define LITTLE_CONFIDENCE 1.5f  // less is smoothed; from here on it would not be seen
#define NEIGHBOUR_WEIGHT 0.3f   // of each neighbour, beside a pixel of no confidence
#define CENTRE_WEIGHT 0.02f     // of the pixel itself, beside its confidence

// The sign of a confidence tells whether a texel has one layer or two. Where both kinds meet, one may hold a blade and
// the other the sky behind it: they are not mixed.
static inline bool is_other_kind(float confidence, float own) {
  return (as_int(confidence) ^ as_int(own)) < 0;
}

// The sums of each pixel's eight neighbours, anywhere, clamped to the edge; in place of those of the other kind it is
// itself counted. The slow path.
static inline EightTexels gather_around(HistoryLayer layer, int x, int y) {
  float4 sums[8];
  for (int i = 0; i < 8; ++i) {
    const float4 own = load_history(layer, y * layer.width + min(x + i, layer.width - 1));
    sums[i] = (float4)(0.0f);
    for (int j = 0; j < 9; ++j) {
      const int column = clamp(x + i + j % 3 - 1, 0, layer.width - 1);
      const int row = clamp(y + j / 3 - 1, 0, layer.height - 1);
      const float4 texel = load_history(layer, row * layer.width + column);
      if (j != 4) sums[i] += is_other_kind(texel.w, own.w) ? own : texel;
    }
  }
  const EightTexels around = {vload16(0, (const float*)sums), vload16(1, (const float*)sums)};
  return around;
}

// Four texels, each replaced by the pixel's own where it is of the other kind.
static inline float16 of_own_kind(float16 texels, float16 own) {
  const int16 signs = (as_int16(texels) ^ as_int16(own)).s33337777bbbbffff;
  return select(texels, own, signs);
}

static inline EightTexels add_own_kind(EightTexels sum, EightTexels texels, EightTexels own) {
  const EightTexels more = {sum.left + of_own_kind(texels.left, own.left),
                            sum.right + of_own_kind(texels.right, own.right)};
  return more;
}

static inline EightTexels first_texels(TwelveTexels row) {
  const EightTexels first = {row.first, row.second};
  return first;
}

// The sums of the neighbours of the middle eight of three rows of ten texels.
static inline EightTexels sum_around(TwelveTexels above, TwelveTexels same, TwelveTexels below) {
  const EightTexels own = next_texels(same);
  EightTexels sum = {(float16)(0.0f), (float16)(0.0f)};
  sum = add_own_kind(sum, first_texels(above), own);
  sum = add_own_kind(sum, next_texels(above), own);
  sum = add_own_kind(sum, second_texels(above), own);
  sum = add_own_kind(sum, first_texels(same), own);
  sum = add_own_kind(sum, second_texels(same), own);
  sum = add_own_kind(sum, first_texels(below), own);
  sum = add_own_kind(sum, next_texels(below), own);
  return add_own_kind(sum, second_texels(below), own);
}

static inline int4 signs_of(TwelveTexels row) {
  return as_int4(row.first.s37bf) | as_int4(row.second.s37bf) | as_int4(row.third.s37bf);
}

static inline int4 common_signs_of(TwelveTexels row) {
  return as_int4(row.first.s37bf) & as_int4(row.second.s37bf) & as_int4(row.third.s37bf);
}

// The same where all of them are inside.
static inline EightTexels load_around(HistoryLayer layer, int x, int y) {
  const int index = y * layer.width + x - 1;
  const TwelveTexels above = load_history12(layer, index - layer.width), same = load_history12(layer, index);
  const TwelveTexels below = load_history12(layer, index + layer.width);
  const bool kinds_meet = any(signs_of(above) | signs_of(same) | signs_of(below)) &&
                          !all(common_signs_of(above) & common_signs_of(same) & common_signs_of(below));
  if (kinds_meet) return sum_around(above, same, below);
  const TwelveTexels both = {above.first + below.first, above.second + below.second, above.third + below.third};
  const EightTexels middle = next_texels(both), right = second_texels(both), beside = second_texels(same);
  const EightTexels around = {both.first + right.left + middle.left + (same.first + beside.left),
                              both.second + right.right + middle.right + (same.second + beside.right)};
  return around;
}

// The parts of each pixel itself and of each of its neighbours in what is shown.
typedef struct SmoothParts {
  float8 own, other;
} SmoothParts;

static inline SmoothParts smooth_parts(float8 confidence) {
  const float8 little = select((float8)(0.0f), (float8)(NEIGHBOUR_WEIGHT), confidence < LITTLE_CONFIDENCE);
  const float8 other = little * bell(2.0f * confidence);
  const float8 own = confidence + CENTRE_WEIGHT;
  const float8 scale = 1.0f / (own + 8.0f * other);
  const SmoothParts parts = {select((float8)(1.0f), own * scale, other > 0.0f), other * scale};
  return parts;
}

// Pixels mixed with their neighbours, whose sums are `around`.
static inline EightTexels smooth_little_known(EightTexels pixels, EightTexels around, SmoothParts parts) {
  const EightTexels smooth = {
      pixels.left * to_four_texels(parts.own.lo) + around.left * to_four_texels(parts.other.lo),
      pixels.right * to_four_texels(parts.own.hi) + around.right * to_four_texels(parts.other.hi)};
  return smooth;
}
