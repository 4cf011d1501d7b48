// SPDX-License-Identifier: MIT
// The cubic at places that lie alike among their texels, eight of a row, row after row: each row of texels is filtered
// along itself once, and then counts for the four rows of places that need it.
#pragma once

#include "temporal/history_sampling.h"

// Of eight places of a row: what the cubic along it gives, and the range of the middle two texels of each.
typedef struct FilteredRow {
  EightTexels sum, least, most;
} FilteredRow;

static inline float16 blend_four(float16 at0, float16 at1, float16 at2, float16 at3, float4 x) {
  return MULTIPLY_ADD(at0, (float16)(x.x), at2 * x.z) + MULTIPLY_ADD(at1, (float16)(x.y), at3 * x.w);
}

// The texels from `index` on are the first of each place's four. All twelve are inside.
static inline FilteredRow filter_row(HistoryLayer layer, int index, float4 x) {
  const TwelveTexels row = load_history12(layer, index);
  const EightTexels at1 = next_texels(row), at2 = second_texels(row), at3 = third_texels(row);
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

// The texel at `index` is the first of the first place's sixteen.
static inline FilteredRows filter_rows(HistoryLayer layer, int index, float4 x) {
  const int width = layer.width;
  const FilteredRows rows = {filter_row(layer, index, x), filter_row(layer, index + width, x),
                             filter_row(layer, index + 2 * width, x), filter_row(layer, index + 3 * width, x)};
  return rows;
}

// The same a row further down, where the sixteen begin at `index`.
static inline FilteredRows next_rows(FilteredRows rows, HistoryLayer layer, int index, float4 x) {
  const FilteredRows next = {rows.row1, rows.row2, rows.row3, filter_row(layer, index + 3 * layer.width, x)};
  return next;
}

static inline float16 blend_held(float16 row0, float16 row1, float16 row2, float16 row3, float16 least, float16 most,
                                 float4 y) {
  return min(max(blend_outer(row0, row1, row2, row3, y), least), most);
}

// The cubic, held in the range of the middle four texels of each place.
static inline EightTexels blend_filtered(const FilteredRows* rows, float4 y) {
  const FilteredRow *r0 = &rows->row0, *r1 = &rows->row1, *r2 = &rows->row2, *r3 = &rows->row3;
  const EightTexels blended = {blend_held(r0->sum.left, r1->sum.left, r2->sum.left, r3->sum.left,
                                          min(r1->least.left, r2->least.left), max(r1->most.left, r2->most.left), y),
                               blend_held(r0->sum.right, r1->sum.right, r2->sum.right, r3->sum.right,
                                          min(r1->least.right, r2->least.right),
                                          max(r1->most.right, r2->most.right), y)};
  return blended;
}
