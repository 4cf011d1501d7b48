// SPDX-License-Identifier: MIT
// Reading a layer of history between 6x6 texels: a Hermite cubic, whose slope at each texel comes from two texels on
// each side. It keeps more of what is resampled in each frame than the cubic of 4x4 texels does.
#pragma once

#include "arithmetic.h"
#include "temporal/constants.h"
#include "temporal/history_sampling.h"

// The weights of eight places on one axis, `fraction` of the way from the third texel to the fourth. The slope at
// texel 0 is LONG_CUBIC_NEAR_SLOPE (t[1] - t[-1]) - LONG_CUBIC_FAR_SLOPE (t[2] - t[-2]).
typedef struct SixWeights {
  float8 w0, w1, w2, w3, w4, w5;
} SixWeights;

static inline SixWeights six_weights(float8 f) {
  const float8 rest = 1.0f - f;
  const float8 before = f * rest * rest, after = -f * f * rest;  // what the slopes at the two texels count
  const float8 next = f * f * (3.0f - 2.0f * f);
  SixWeights w;
  w.w0 = LONG_CUBIC_FAR_SLOPE * before;
  w.w1 = LONG_CUBIC_FAR_SLOPE * after - LONG_CUBIC_NEAR_SLOPE * before;
  w.w2 = 1.0f - next - LONG_CUBIC_NEAR_SLOPE * after;
  w.w3 = next + LONG_CUBIC_NEAR_SLOPE * before;
  w.w4 = LONG_CUBIC_NEAR_SLOPE * after - LONG_CUBIC_FAR_SLOPE * before;
  w.w5 = -LONG_CUBIC_FAR_SLOPE * after;
  return w;
}

// Returns the six weights of the first place, and two that do not count.
static inline float8 first_six(SixWeights w) {
  return (float8)(w.w0.s0, w.w1.s0, w.w2.s0, w.w3.s0, w.w4.s0, w.w5.s0, 0.0f, 0.0f);
}

// Returns the weights with the second place as the first, and the first as the last.
static inline SixWeights next_six(SixWeights w) {
  const SixWeights next = {NEXT_LANES(w.w0), NEXT_LANES(w.w1), NEXT_LANES(w.w2),
                           NEXT_LANES(w.w3), NEXT_LANES(w.w4), NEXT_LANES(w.w5)};
  return next;
}

// Six texels of a row.
typedef struct SixTexels {
  float16 first;  // four
  float8 last;    // two
} SixTexels;

// Loads those from (x, y) on; `inside`: they are there, else they are clamped to the edge.
static inline SixTexels load_six(HistoryLayer layer, int x, int y, bool inside) {
  if (ON_CPU && inside) {
    const int index = y * layer.width + x;
    const SixTexels row = {load_history4(layer, index), load_history2(layer, index + 4)};
    return row;
  }
  const float16 first = load_clamped4(layer, x, y), last = load_clamped4(layer, x + 4, y);
  const SixTexels row = {first, last.lo};
  return row;
}

static inline void add_six(SixTexels* sum, SixTexels row, float weight) {
  sum->first = MULTIPLY_ADD(row.first, (float16)(weight), sum->first);
  sum->last = MULTIPLY_ADD(row.last, (float8)(weight), sum->last);
}

static inline SixTexels least_of_six(SixTexels a, SixTexels b) {
  const SixTexels least = {min(a.first, b.first), min(a.last, b.last)};
  return least;
}

static inline SixTexels most_of_six(SixTexels a, SixTexels b) {
  const SixTexels most = {max(a.first, b.first), max(a.last, b.last)};
  return most;
}

// Returns history among the 6x6 texels from (x, y) on, held in the range of the middle 4x4.
static inline float4 sample_six(HistoryLayer layer, int x, int y, bool inside, float8 wx, float8 wy) {
  const SixTexels row0 = load_six(layer, x, y, inside), row1 = load_six(layer, x, y + 1, inside);
  const SixTexels row2 = load_six(layer, x, y + 2, inside), row3 = load_six(layer, x, y + 3, inside);
  const SixTexels row4 = load_six(layer, x, y + 4, inside), row5 = load_six(layer, x, y + 5, inside);
  SixTexels sum = {row0.first * wy.s0, row0.last * wy.s0};
  add_six(&sum, row1, wy.s1);
  add_six(&sum, row2, wy.s2);
  add_six(&sum, row3, wy.s3);
  add_six(&sum, row4, wy.s4);
  add_six(&sum, row5, wy.s5);
  const float4 blended = (sum.first.s0123 * wx.s0 + sum.first.s4567 * wx.s1) +
                         (sum.first.s89ab * wx.s2 + sum.first.scdef * wx.s3) +
                         (sum.last.lo * wx.s4 + sum.last.hi * wx.s5);
  const SixTexels least = least_of_six(least_of_six(row1, row2), least_of_six(row3, row4));
  const SixTexels most = most_of_six(most_of_six(row1, row2), most_of_six(row3, row4));
  const float4 low = min(min(least.first.s4567, least.first.s89ab), min(least.first.scdef, least.last.lo));
  const float4 high = max(max(most.first.s4567, most.first.s89ab), max(most.first.scdef, most.last.lo));
  return min(max(blended, low), high);
}

// Returns alpha in the same way, clamped to the edge.
static inline float sample_alpha_six(AlphaPlane plane, int x, int y, float8 wx, float8 wy) {
  float weight[8], sum = 0.0f, low = INFINITY, high = -INFINITY;
  vstore8(wy, 0, weight);
  for (int j = 0; j < 6; ++j) {
    const float4 first = load_alpha_clamped4(plane, x, y + j), last = load_alpha_clamped4(plane, x + 4, y + j);
    sum += weight[j] * (dot(first, wx.lo) + dot(last.lo, wx.s45));
    if (j == 0 || j == 5) continue;
    low = min(low, min(min(first.y, first.z), min(first.w, last.x)));
    high = max(high, max(max(first.y, first.z), max(first.w, last.x)));
  }
  return min(max(sum, low), high);
}
