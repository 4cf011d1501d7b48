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

// The sums of each pixel's eight neighbours, anywhere, clamped to the edge. The slow path.
static inline EightTexels gather_around(HistoryLayer layer, int x, int y) {
  float4 sums[8];
  for (int i = 0; i < 8; ++i) {
    sums[i] = (float4)(0.0f);
    for (int j = 0; j < 9; ++j) {
      const int column = clamp(x + i + j % 3 - 1, 0, layer.width - 1);
      const int row = clamp(y + j / 3 - 1, 0, layer.height - 1);
      if (j != 4) sums[i] += load_history(layer, row * layer.width + column);
    }
  }
  const EightTexels around = {vload16(0, (const float*)sums), vload16(1, (const float*)sums)};
  return around;
}

// The same where all of them are inside.
static inline EightTexels load_around(HistoryLayer layer, int x, int y) {
  const int index = y * layer.width + x - 1;
  const TwelveTexels above = load_history12(layer, index - layer.width), same = load_history12(layer, index);
  const TwelveTexels below = load_history12(layer, index + layer.width);
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
