// SPDX-License-Identifier: MIT
// Reading history where texels may have two layers: some rows of four texels that may lie anywhere.
#pragma once

#include "layers/past_layers.h"

// The states of four texels.
typedef struct LayerStates {
  float4 far_depth, near_depth, near_confidence;
} LayerStates;

// Some rows of four texels from (x, y) on.
typedef struct TexelWindow {
  int x, y;
  bool is_inside;   // all of them are
  bool has_states;  // all of them have been stored
} TexelWindow;

static inline TexelWindow window_at(const PastLayers* past, int x, int y, int rows) {
  TexelWindow window = {x, y, false, false};
  window.is_inside = x >= 0 && y >= 0 && x + 4 <= past->far.width && y + rows <= past->far.height;
  if (!window.is_inside) return window;
  const int left = x / kTemporalTile, right = (x + 3) / kTemporalTile;
  __global const LayerTile* upper = past->layer_tiles + y / kTemporalTile * past->tiles_x;
  __global const LayerTile* lower = past->layer_tiles + (y + rows - 1) / kTemporalTile * past->tiles_x;
  window.has_states =
      (upper[left].is_layered & upper[right].is_layered & lower[left].is_layered & lower[right].is_layered) != 0;
  return window;
}

// Of a row of the window, clamped to the edge as all that follow.
static inline LayerStates states_of_row(const PastLayers* past, DEPTH_TEXELS depth, TexelLayout layout,
                                        TexelWindow window, int row) {
  LayerStates states;
  const int x = window.x;
  const int y = window.is_inside ? window.y + row : clamp(window.y + row, 0, past->far.height - 1);
  if (window.has_states) {
    const float16 stored = load_half_texels4(past->states, y * past->far.width + x);
    const float4 far = stored.s048c * stored.s048c, near = stored.s159d * stored.s159d;
    states.far_depth = far * far;
    states.near_depth = near * near;
    states.near_confidence = stored.s26ae;
    return states;
  }
  LayerState state[4];
  for (int i = 0; i < 4; ++i)
    state[i] = state_at(past, depth, layout, clamp(x + i, 0, past->far.width - 1), y);
  states.far_depth = (float4)(state[0].far_depth, state[1].far_depth, state[2].far_depth, state[3].far_depth);
  states.near_depth = (float4)(state[0].near_depth, state[1].near_depth, state[2].near_depth, state[3].near_depth);
  states.near_confidence = (float4)(state[0].near_confidence, state[1].near_confidence, state[2].near_confidence,
                                    state[3].near_confidence);
  return states;
}

static inline float16 load_row(HistoryLayer layer, TexelWindow window, int row) {
  return window.is_inside ? load_history4(layer, (window.y + row) * layer.width + window.x)
                          : load_clamped4(layer, window.x, window.y + row);
}

// 1 without ALPHA.
static inline float4 alpha_of_row(AlphaPlane plane, TexelWindow window, int row) {
#if ALPHA
  return load_alpha_clamped4(plane, window.x, window.y + row);
#else
  return (float4)(1.0f);
#endif
}

static inline float16 with_coverage(float16 colours, float coverage) {
  return select(colours, (float16)(coverage), LAST_CHANNELS);
}
