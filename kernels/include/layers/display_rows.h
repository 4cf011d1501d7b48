// SPDX-License-Identifier: MIT
// The near layer of the texels around eight pixels of a row, as a picture that can be resampled.
#pragma once

#include "layers/layer_row.h"
#include "temporal/display_place.h"

static inline int16 to_four_masks(int4 lanes) {
  return (int16)((int4)(lanes.x), (int4)(lanes.y), (int4)(lanes.z), (int4)(lanes.w));
}

// Premultiplied colours and coverages of a row of a window. What stands before `between` alone covers wholly, what is
// behind it not at all.
static inline float16 near_of_row(const PastLayers* known, DEPTH_TEXELS depth, TexelLayout layout, float between,
                                  TexelWindow window, int row) {
  const float16 far = load_row(known->far, window, row);
  const int4 two = as_int4(far.s37bf) < 0;
  float16 near = (float16)(0.0f);
  if (!all(two)) {
    const LayerStates states = states_of_row(known, depth, layout, window, row);
    near = select(near, with_coverage(far, 1.0f), to_four_masks(states.far_depth > between));
  }
  if (any(two)) near = select(near, load_row(known->near, window, row), to_four_masks(two));
  return near;
}

// Twelve texels of a row of windows side by side.
static inline TwelveTexels near_row_of(const PastLayers* known, DEPTH_TEXELS depth, TexelLayout layout, float between,
                                       const RowWindows* windows, int row) {
  const TwelveTexels texels = {near_of_row(known, depth, layout, between, windows->first, row),
                               near_of_row(known, depth, layout, between, windows->second, row),
                               near_of_row(known, depth, layout, between, windows->third, row)};
  return texels;
}

// The near layer's picture at the pixels from (x, y) on; of those of one layer anything.
static inline EightTexels show_near(const PastLayers* known, DEPTH_TEXELS depth, TexelLayout layout, float between,
                                    Display display, int x, int y) {
  if (!display.has_phase) {
    const EightTexels own = {load_row(known->near, window_at(known, x, y, 1), 0),
                             load_row(known->near, window_at(known, x + 4, y, 1), 0)};
    return own;
  }
  const RowWindows windows = windows_from(known, x - display.step_x, y - display.step_y, 4);
  return blend_rows(near_row_of(known, depth, layout, between, &windows, 0),
                    near_row_of(known, depth, layout, between, &windows, 1),
                    near_row_of(known, depth, layout, between, &windows, 2),
                    near_row_of(known, depth, layout, between, &windows, 3), display.wx, display.wy);
}
