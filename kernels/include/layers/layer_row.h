// SPDX-License-Identifier: MIT
// Texels of a row of history by channel: those that eight neighbouring pixels see which all come from as far. On texels
// these are eight, between texels twelve.
#pragma once

#include "layers/layer_window.h"
#include "sanitise.h"

// The last four lanes of each channel are not used.
typedef struct LayerRow {
  float16 red, green, blue, confidence;               // of the far layer, or the only one, as stored
  float16 near_red, near_green, near_blue, coverage;  // 0 where none of the texels has two layers
  float16 far_depth, near_depth, near_confidence;
  float16 alpha;                                      // 1 without ALPHA
} LayerRow;

// Where rows of twelve texels lie.
typedef struct RowWindows {
  TexelWindow first, second, third;
} RowWindows;

static inline RowWindows windows_from(const PastLayers* past, int x, int y, int rows) {
  const RowWindows windows = {window_at(past, x, y, rows), window_at(past, x + 4, y, rows),
                              window_at(past, x + 8, y, rows)};
  return windows;
}

static inline float16 join(float4 first, float4 second, float4 third) {
  return (float16)(first, second, third, third);
}

static inline LayerRow load_layer_row(const PastLayers* past, DEPTH_TEXELS depth, TexelLayout layout,
                                      const RowWindows* windows, int row) {
  LayerRow loaded;
  const float16 far0 = load_row(past->far, windows->first, row);
  const float16 far1 = load_row(past->far, windows->second, row);
  const float16 far2 = load_row(past->far, windows->third, row);
  loaded.red = join(far0.s048c, far1.s048c, far2.s048c);
  loaded.green = join(far0.s159d, far1.s159d, far2.s159d);
  loaded.blue = join(far0.s26ae, far1.s26ae, far2.s26ae);
  loaded.confidence = join(far0.s37bf, far1.s37bf, far2.s37bf);
  loaded.near_red = loaded.near_green = loaded.near_blue = loaded.coverage = (float16)(0.0f);
  const int16 two = as_int16(loaded.confidence) >> 31;
  if (any_lane(two.lo | two.hi)) {
    const float16 near0 = load_row(past->near, windows->first, row);
    const float16 near1 = load_row(past->near, windows->second, row);
    const float16 near2 = load_row(past->near, windows->third, row);
    loaded.near_red = join(near0.s048c, near1.s048c, near2.s048c);
    loaded.near_green = join(near0.s159d, near1.s159d, near2.s159d);
    loaded.near_blue = join(near0.s26ae, near1.s26ae, near2.s26ae);
    loaded.coverage = join(near0.s37bf, near1.s37bf, near2.s37bf);
  }
  const LayerStates states0 = states_of_row(past, depth, layout, windows->first, row);
  const LayerStates states1 = states_of_row(past, depth, layout, windows->second, row);
  const LayerStates states2 = states_of_row(past, depth, layout, windows->third, row);
  loaded.far_depth = join(states0.far_depth, states1.far_depth, states2.far_depth);
  loaded.near_depth = join(states0.near_depth, states1.near_depth, states2.near_depth);
  loaded.near_confidence = join(states0.near_confidence, states1.near_confidence, states2.near_confidence);
  loaded.alpha = join(alpha_of_row(past->alpha, windows->first, row), alpha_of_row(past->alpha, windows->second, row),
                      alpha_of_row(past->alpha, windows->third, row));
  return loaded;
}

// Eight texels, as a LayerRow has them: one for each pixel.
typedef struct EightLayers {
  float8 red, green, blue, confidence;
  float8 near_red, near_green, near_blue, coverage;
  float8 far_depth, near_depth, near_confidence;
  float8 alpha;
} EightLayers;

static inline float8 eight_from(float16 row, int column) {
  if (column == 0) return row.s01234567;
  if (column == 1) return row.s12345678;
  return column == 2 ? row.s23456789 : row.s3456789a;
}

// Eight of the twelve, from `column`, 0 to 3, on.
static inline EightLayers eight_of_row(const LayerRow* row, int column) {
  const EightLayers eight = {eight_from(row->red, column),        eight_from(row->green, column),
                             eight_from(row->blue, column),       eight_from(row->confidence, column),
                             eight_from(row->near_red, column),   eight_from(row->near_green, column),
                             eight_from(row->near_blue, column),  eight_from(row->coverage, column),
                             eight_from(row->far_depth, column),  eight_from(row->near_depth, column),
                             eight_from(row->near_confidence, column), eight_from(row->alpha, column)};
  return eight;
}

// The eight from (x, y) on.
static inline EightLayers load_eight_layers(const PastLayers* past, DEPTH_TEXELS depth, TexelLayout layout, int x,
                                            int y) {
  const TexelWindow left = window_at(past, x, y, 1), right = window_at(past, x + 4, y, 1);
  const float16 far0 = load_row(past->far, left, 0), far1 = load_row(past->far, right, 0);
  EightLayers loaded;
  loaded.red = (float8)(far0.s048c, far1.s048c);
  loaded.green = (float8)(far0.s159d, far1.s159d);
  loaded.blue = (float8)(far0.s26ae, far1.s26ae);
  loaded.confidence = (float8)(far0.s37bf, far1.s37bf);
  loaded.near_red = loaded.near_green = loaded.near_blue = loaded.coverage = (float8)(0.0f);
  if (any_lane(as_int8(loaded.confidence) >> 31)) {
    const float16 near0 = load_row(past->near, left, 0), near1 = load_row(past->near, right, 0);
    loaded.near_red = (float8)(near0.s048c, near1.s048c);
    loaded.near_green = (float8)(near0.s159d, near1.s159d);
    loaded.near_blue = (float8)(near0.s26ae, near1.s26ae);
    loaded.coverage = (float8)(near0.s37bf, near1.s37bf);
  }
  const LayerStates states0 = states_of_row(past, depth, layout, left, 0);
  const LayerStates states1 = states_of_row(past, depth, layout, right, 0);
  loaded.far_depth = (float8)(states0.far_depth, states1.far_depth);
  loaded.near_depth = (float8)(states0.near_depth, states1.near_depth);
  loaded.near_confidence = (float8)(states0.near_confidence, states1.near_confidence);
  loaded.alpha = (float8)(alpha_of_row(past->alpha, left, 0), alpha_of_row(past->alpha, right, 0));
  return loaded;
}
