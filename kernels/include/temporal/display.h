// SPDX-License-Identifier: MIT
// Displays a history's pixels: resampled at their centres, and smoothed where their confidence is low.
//
// Option: SMOOTH  1 (default) | 0
#pragma once

#include "arithmetic.h"
#include "temporal/constants.h"
#include "temporal/history_sampling.h"

#ifndef SMOOTH
#define SMOOTH 1
#endif
#if SMOOTH < 0 || SMOOTH > 1
#error "SMOOTH must be 0 or 1"
#endif

// How the pixels of a tile are resampled: which texel is the first of the four around the centre of each, and their
// weights on each axis.
typedef struct Display {
  int step_x, step_y;  // the first of the four lies so many texels before the pixel's own
  float4 wx, wy;
  bool has_phase;  // false: nothing needs to be resampled
} Display;

static inline Display display_of(float phase_x, float phase_y) {
  Display display;
  display.has_phase = phase_x != 0.0f || phase_y != 0.0f;
  display.step_x = 1 + (phase_x > 0.0f);
  display.step_y = 1 + (phase_y > 0.0f);
  display.wx = first_weights(cubic_weights((LaneFloat)((float)(display.step_x - 1) - phase_x), DISPLAY_SHARPNESS));
  display.wy = first_weights(cubic_weights((LaneFloat)((float)(display.step_y - 1) - phase_y), DISPLAY_SHARPNESS));
  return display;
}

#if LANES == 8
// ---- The cubic at places that lie alike among their texels, eight of a row, row after row: each row of texels is
// filtered along itself once, and then counts for the four rows of places that need it.

// The cubic along a row of texels at eight places, and the range of the middle two texels of each.
typedef struct FilteredRow {
  LaneTexels sum, least, most;
} FilteredRow;

static inline float16 blend_four(float16 at0, float16 at1, float16 at2, float16 at3, float4 x) {
  return MULTIPLY_ADD(at0, (float16)(x.x), at2 * x.z) + MULTIPLY_ADD(at1, (float16)(x.y), at3 * x.w);
}

// The texels from `index` on are the first of each place's four. All twelve are inside.
static inline FilteredRow filter_row(HistoryLayer layer, int index, float4 x) {
  const TwelveTexels row = load_history12(layer, index);
  const LaneTexels at1 = next_texels(row), at2 = second_texels(row), at3 = third_texels(row);
  const FilteredRow filtered = {
      {blend_four(row.first, at1.left, at2.left, at3.left, x),
       blend_four(row.second, at1.right, at2.right, at3.right, x)},
      {min(at1.left, at2.left), min(at1.right, at2.right)},
      {max(at1.left, at2.left), max(at1.right, at2.right)}};
  return filtered;
}

// Those around a row of places.
typedef struct FilteredRows {
  FilteredRow row0, row1, row2, row3;
} FilteredRows;

static inline FilteredRows no_rows(void) {
  const FilteredRow none = {no_texels(), no_texels(), no_texels()};
  const FilteredRows rows = {none, none, none, none};
  return rows;
}

static inline FilteredRows push_row(FilteredRows rows, FilteredRow row) {
  const FilteredRows pushed = {rows.row1, rows.row2, rows.row3, row};
  return pushed;
}

// The texel at `index` is the first of the first place's sixteen.
static inline FilteredRows filter_rows(HistoryLayer layer, int index, float4 x) {
  FilteredRows rows = no_rows();
  UNROLL(4)
  for (int i = 0; i < 4; ++i) rows = push_row(rows, filter_row(layer, index + i * layer.width, x));
  return rows;
}

// The same a row further down, where the sixteen begin at `index`.
static inline FilteredRows next_rows(FilteredRows rows, HistoryLayer layer, int index, float4 x) {
  return push_row(rows, filter_row(layer, index + 3 * layer.width, x));
}

static inline float16 blend_held(float16 row0, float16 row1, float16 row2, float16 row3, float16 least, float16 most,
                                 float4 y) {
  return min(max(blend_outer(row0, row1, row2, row3, y), least), most);
}

// The cubic, held in the range of the middle four texels of each place.
static inline LaneTexels blend_filtered(const FilteredRows* rows, float4 y) {
  const FilteredRow *r0 = &rows->row0, *r1 = &rows->row1, *r2 = &rows->row2, *r3 = &rows->row3;
  const LaneTexels blended = {blend_held(r0->sum.left, r1->sum.left, r2->sum.left, r3->sum.left,
                                          min(r1->least.left, r2->least.left), max(r1->most.left, r2->most.left), y),
                               blend_held(r0->sum.right, r1->sum.right, r2->sum.right, r3->sum.right,
                                          min(r1->least.right, r2->least.right),
                                          max(r1->most.right, r2->most.right), y)};
  return blended;
}
#endif

// ---- Smoothing of pixels of little confidence. +.1 dB (docs/lab/temporal.md).

// The sign of a confidence tells whether a texel has one layer or two. Where both kinds meet, one may hold a blade and
// the other the sky behind it: they are not mixed.
static inline bool is_other_kind(float confidence, float own) {
  return (as_int(confidence) ^ as_int(own)) < 0;
}

// The sums of each pixel's eight neighbours, anywhere, clamped to the edge; in place of those of the other kind it is
// itself counted. The slow path.
static inline LaneTexels gather_around(HistoryLayer layer, int x, int y) {
  LaneTexels around = no_texels();
  for (int i = 0; i < kLanes; ++i) {
    const float4 own = load_history(layer, y * layer.width + min(x + i, layer.width - 1));
    float4 sum = (float4)(0.0f);
    for (int j = 0; j < 9; ++j) {
      const int column = clamp(x + i + j % 3 - 1, 0, layer.width - 1);
      const int row = clamp(y + j / 3 - 1, 0, layer.height - 1);
      const float4 texel = load_history(layer, row * layer.width + column);
      if (j != 4) sum += is_other_kind(texel.w, own.w) ? own : texel;
    }
    around = push_texel(around, sum);
  }
  return around;
}

#if LANES == 8
// Four texels, each replaced by the pixel's own where it is of the other kind.
static inline float16 of_own_kind(float16 texels, float16 own) {
  const int16 signs = (as_int16(texels) ^ as_int16(own)).s33337777bbbbffff;
  return select(texels, own, signs);
}

static inline LaneTexels add_own_kind(LaneTexels sum, LaneTexels texels, LaneTexels own) {
  const LaneTexels more = {sum.left + of_own_kind(texels.left, own.left),
                            sum.right + of_own_kind(texels.right, own.right)};
  return more;
}

static inline LaneTexels first_texels(TwelveTexels row) {
  const LaneTexels first = {row.first, row.second};
  return first;
}

// The sums of the neighbours of the middle eight of three rows of ten texels.
static inline LaneTexels sum_around(TwelveTexels above, TwelveTexels same, TwelveTexels below) {
  const LaneTexels own = next_texels(same);
  LaneTexels sum = no_texels();
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
static inline LaneTexels load_around(HistoryLayer layer, int x, int y) {
  const int index = y * layer.width + x - 1;
  const TwelveTexels above = load_history12(layer, index - layer.width), same = load_history12(layer, index);
  const TwelveTexels below = load_history12(layer, index + layer.width);
  const bool kinds_meet = any(signs_of(above) | signs_of(same) | signs_of(below)) &&
                          !all(common_signs_of(above) & common_signs_of(same) & common_signs_of(below));
  if (kinds_meet) return sum_around(above, same, below);
  const TwelveTexels both = {above.first + below.first, above.second + below.second, above.third + below.third};
  const LaneTexels middle = next_texels(both), right = second_texels(both), beside = second_texels(same);
  const LaneTexels around = {both.first + right.left + middle.left + (same.first + beside.left),
                              both.second + right.right + middle.right + (same.second + beside.right)};
  return around;
}
#endif

// The parts of each pixel itself and of each of its neighbours in what is shown.
typedef struct SmoothParts {
  LaneFloat own, other;
} SmoothParts;

static inline SmoothParts smooth_parts(LaneFloat confidence) {
  const LaneMask is_little = confidence < SMOOTHED_CONFIDENCE_MAX;
  const LaneFloat little = select((LaneFloat)(0.0f), (LaneFloat)(SMOOTHING_NEIGHBOUR_WEIGHT), is_little);
  const LaneFloat other = little * bell(SMOOTHING_FALLOFF * confidence);
  const LaneFloat own = confidence + SMOOTHING_OWN_WEIGHT;
  const LaneFloat scale = 1.0f / (own + 8.0f * other);
  const SmoothParts parts = {select((LaneFloat)(1.0f), own * scale, other > 0.0f), other * scale};
  return parts;
}

// Pixels mixed with their neighbours, whose sums are `around`.
static inline LaneTexels smooth_little_known(LaneTexels pixels, LaneTexels around, SmoothParts parts) {
  return add_times(times(around, parts.other), pixels, parts.own);
}
