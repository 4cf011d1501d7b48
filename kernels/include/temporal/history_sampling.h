// SPDX-License-Identifier: MIT
// Reading a layer of history between its texels.
//
// Option: TAPS  16 (default): cubic | 4: bilinear | 36: six taps (temporal/fetch_history.h) where resolve_temporal
//               resamples, cubic elsewhere
#pragma once

#include "arithmetic.h"
#include "temporal/history.h"

#ifndef TAPS
#define TAPS 16
#endif
#if TAPS != 36 && TAPS != 16 && TAPS != 4
#error "TAPS must be 36, 16 or 4"
#endif

// The 4x4 texels around a place that lies between the middle four.
typedef struct Neighbourhood {
  float16 row0, row1, row2, row3;
} Neighbourhood;

// Loads the texels from (x, y) on, all inside.
static inline Neighbourhood load_neighbourhood(HistoryLayer layer, int x, int y) {
  const int width = layer.width;
  const int index = y * width + x;
  const Neighbourhood around = {load_history4(layer, index), load_history4(layer, index + width),
                                load_history4(layer, index + 2 * width), load_history4(layer, index + 3 * width)};
  return around;
}

// Prefetches four rows from (x, y) on, which may be anywhere.
static inline void will_read_rows(HistoryLayer layer, int x, int y) {
  for (int row = 0; row < 4; ++row)
    will_read_history(layer, (y + row) * layer.width + x);
}

static inline float16 load_clamped4(HistoryLayer layer, int x, int y) {
  const int row = clamp(y, 0, layer.height - 1) * layer.width;
  const int last = layer.width - 1;
  return (float16)(load_history(layer, row + clamp(x, 0, last)), load_history(layer, row + clamp(x + 1, 0, last)),
                   load_history(layer, row + clamp(x + 2, 0, last)), load_history(layer, row + clamp(x + 3, 0, last)));
}

// Loads them from anywhere, clamped to the edge.
static inline Neighbourhood load_neighbourhood_clamped(HistoryLayer layer, int x, int y) {
  const Neighbourhood around = {load_clamped4(layer, x, y), load_clamped4(layer, x, y + 1),
                                load_clamped4(layer, x, y + 2), load_clamped4(layer, x, y + 3)};
  return around;
}

// The weights of the four texels around each lane's place on one axis; where TAPS is 4 the outer two are 0.
typedef struct Cubic {
  LaneFloat w0, w1, w2, w3;
} Cubic;

static inline Cubic tent_weights(LaneFloat f) {
  const Cubic tent = {(LaneFloat)(0.0f), 1.0f - f, f, (LaneFloat)(0.0f)};
  return tent;
}

// Returns Keys' weights, "Cubic Convolution Interpolation for Digital Image Processing", 1981, with his `a`.
static inline Cubic cubic_weights(LaneFloat f, float a) {
#if TAPS == 4
  return tent_weights(f);
#else
  const LaneFloat rest = 1.0f - f;
  Cubic w;
  w.w0 = a * f * rest * rest;
  w.w3 = a * rest * f * f;
  w.w1 = ((a + 2.0f) * f - (a + 3.0f)) * f * f + 1.0f;
  w.w2 = 1.0f - w.w0 - w.w1 - w.w3;
  return w;
#endif
}

// Returns the four weights of the first place.
static inline float4 first_weights(Cubic w) {
  return (float4)(FIRST_LANE(w.w0), FIRST_LANE(w.w1), FIRST_LANE(w.w2), FIRST_LANE(w.w3));
}

// Returns the weights with the second place as the first, and the first as the last.
static inline Cubic next_weights(Cubic w) {
  const Cubic next = {NEXT_LANES(w.w0), NEXT_LANES(w.w1), NEXT_LANES(w.w2), NEXT_LANES(w.w3)};
  return next;
}

static inline bool is_middle_tap(int i) {
  return i == 1 || i == 2;
}

// Returns the weights of the middle taps, 1 and 2, in a bilinear blend.
static inline LaneFloat middle_weight(int i, LaneFloat fraction) {
  return i == 1 ? 1.0f - fraction : fraction;
}

static inline float4 blend_columns(float16 row, float4 w) {
  const float8 outer = row.hi * (float8)((float4)(w.z), (float4)(w.w));
  const float8 pair = MULTIPLY_ADD(row.lo, (float8)((float4)(w.x), (float4)(w.y)), outer);
  return pair.lo + pair.hi;
}

// Blends two rows of two texels.
static inline float4 blend_pairs(float8 upper, float8 lower, float4 x, float4 y) {
  const float8 rows = MULTIPLY_ADD(upper, (float8)(y.y), lower * y.z);
  return MULTIPLY_ADD(rows.lo, (float4)(x.y), rows.hi * x.z);
}

// Returns the cubic, held in the range of the middle four.
static inline float4 sample_neighbourhood(Neighbourhood around, float4 x, float4 y) {
  const float16 outer = MULTIPLY_ADD(around.row0, (float16)(y.x), around.row3 * y.w);
  const float16 rows = MULTIPLY_ADD(around.row1, (float16)(y.y), MULTIPLY_ADD(around.row2, (float16)(y.z), outer));
  const float16 least = min(around.row1, around.row2);
  const float16 most = max(around.row1, around.row2);
  return min(max(blend_columns(rows, x), min(least.s4567, least.s89ab)), max(most.s4567, most.s89ab));
}

// Returns history at a place with weights x and y among the 4x4 texels from (x0, y0) on; `inside`: they are all there,
// else they are clamped to the edge.
static inline float4 sample_history(HistoryLayer layer, int x0, int y0, bool inside, float4 x, float4 y) {
#if TAPS == 4
  const int index = (y0 + 1) * layer.width + x0 + 1;
  if (LANES == 8 && inside)
    return blend_pairs(load_history2(layer, index), load_history2(layer, index + layer.width), x, y);
  const Neighbourhood around = load_neighbourhood_clamped(layer, x0, y0);
  return blend_pairs(around.row1.s456789ab, around.row2.s456789ab, x, y);
#else
  const Neighbourhood around =
      LANES == 8 && inside ? load_neighbourhood(layer, x0, y0) : load_neighbourhood_clamped(layer, x0, y0);
  return sample_neighbourhood(around, x, y);
#endif
}

#if LANES == 8
// Texels of a row, blended or compared; of the last four only the first three count.
typedef struct TwelveTexels {
  float16 first, second, third;
} TwelveTexels;

static inline TwelveTexels load_history12(HistoryLayer layer, int index) {
  const TwelveTexels row = {load_history4(layer, index), load_history4(layer, index + 4),
                            load_history4(layer, index + 8)};
  return row;
}

static inline LaneTexels next_texels(TwelveTexels row) {
  const LaneTexels next = {(float16)(row.first.s456789ab, row.first.scdef, row.second.s0123),
                            (float16)(row.second.s456789ab, row.second.scdef, row.third.s0123)};
  return next;
}

static inline LaneTexels second_texels(TwelveTexels row) {
  const LaneTexels next = {(float16)(row.first.s89abcdef, row.second.s01234567),
                            (float16)(row.second.s89abcdef, row.third.s01234567)};
  return next;
}

#if TAPS != 4
static inline LaneTexels third_texels(TwelveTexels row) {
  const LaneTexels next = {(float16)(row.first.scdef, row.second.s0123, row.second.s456789ab),
                            (float16)(row.second.scdef, row.third.s0123, row.third.s456789ab)};
  return next;
}

static inline float16 blend_outer(float16 row0, float16 row1, float16 row2, float16 row3, float4 y) {
  const float16 outer = MULTIPLY_ADD(row0, (float16)(y.x), row3 * y.w);
  return MULTIPLY_ADD(row1, (float16)(y.y), MULTIPLY_ADD(row2, (float16)(y.z), outer));
}

// Returns the cubic at places of a row that lie alike among their texels, held in the range of the middle four of
// each. Four rows of texels begin at the first of those around the first place.
static inline LaneTexels blend_rows(TwelveTexels row0, TwelveTexels row1, TwelveTexels row2, TwelveTexels row3,
                                    float4 x, float4 y) {
  const TwelveTexels rows = {blend_outer(row0.first, row1.first, row2.first, row3.first, y),
                             blend_outer(row0.second, row1.second, row2.second, row3.second, y),
                             blend_outer(row0.third, row1.third, row2.third, row3.third, y)};
  const TwelveTexels low = {min(row1.first, row2.first), min(row1.second, row2.second), min(row1.third, row2.third)};
  const TwelveTexels high = {max(row1.first, row2.first), max(row1.second, row2.second), max(row1.third, row2.third)};
  const LaneTexels at1 = next_texels(rows), at2 = second_texels(rows), at3 = third_texels(rows);
  const LaneTexels low1 = next_texels(low), low2 = second_texels(low);
  const LaneTexels high1 = next_texels(high), high2 = second_texels(high);
  const float16 left = MULTIPLY_ADD(rows.first, (float16)(x.x), at2.left * x.z) +
                       MULTIPLY_ADD(at1.left, (float16)(x.y), at3.left * x.w);
  const float16 right = MULTIPLY_ADD(rows.second, (float16)(x.x), at2.right * x.z) +
                        MULTIPLY_ADD(at1.right, (float16)(x.y), at3.right * x.w);
  const LaneTexels held = {min(max(left, min(low1.left, low2.left)), max(high1.left, high2.left)),
                            min(max(right, min(low1.right, low2.right)), max(high1.right, high2.right))};
  return held;
}
#endif
#endif

#if TAPS != 4
// Returns the cubic of 4x4 alphas, held in the range of the middle four.
static inline float blend_alpha_rows(float4 row0, float4 row1, float4 row2, float4 row3, float4 x, float4 y) {
  const float4 outer = MULTIPLY_ADD(row0, (float4)(y.x), row3 * y.w);
  const float4 rows = MULTIPLY_ADD(row1, (float4)(y.y), MULTIPLY_ADD(row2, (float4)(y.z), outer));
  const float2 least = min(row1.yz, row2.yz), most = max(row1.yz, row2.yz);
  return min(max(dot(rows, x), min(least.x, least.y)), max(most.x, most.y));
}
#endif

// Returns alpha as sample_history() returns colour.
static inline float sample_alpha(AlphaPlane plane, int x0, int y0, float4 x, float4 y) {
  const float4 row1 = load_alpha_clamped4(plane, x0, y0 + 1), row2 = load_alpha_clamped4(plane, x0, y0 + 2);
#if TAPS == 4
  return dot(MULTIPLY_ADD(row1, (float4)(y.y), row2 * y.z), x);
#else
  const float4 row0 = load_alpha_clamped4(plane, x0, y0), row3 = load_alpha_clamped4(plane, x0, y0 + 3);
  return blend_alpha_rows(row0, row1, row2, row3, x, y);
#endif
}
