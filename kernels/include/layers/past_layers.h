// SPDX-License-Identifier: MIT
// A history of two layers: its texels, and rows of them. Eight pixels read twelve texels of a row if they lie between
// texels, and eight if they lie on texels; one pixel reads texel by texel. All may lie anywhere and are clamped to the
// edge.
#pragma once

#include "arithmetic.h"
#include "bits.h"
#include "layers/layer.h"
#include "temporal/fetch_history.h"
#include "temporal/history.h"

typedef enum LayerKind {
  kFarLayer,   // the far layer of split pixels, the only surface of the others
  kNearLayer,  // the near layer of split pixels
} LayerKind;

// A frame's layers, and what they follow from where they are not stored.
typedef struct PastLayers {
  HistoryLayer far;                        // colour and confidence
  AlphaPlane alpha;                        // with ALPHA: the far layer's
  HistoryLayer near;                       // colour, times coverage, and coverage
  __global const half* states;             // see LayerState
  __global const TileReprojection* tiles;  // the far layer's
  __global const LayerTile* layer_tiles;
  int tiles_x, tiles_y;
  HistorySamples samples;
} PastLayers;

// Returns the layers of a history of width x height texels. Without ALPHA `alpha` is not read.
static inline PastLayers past_layers(int width, int height, HistorySamples samples, HISTORY_TEXELS far,
                                     HISTORY_TEXELS alpha, HISTORY_TEXELS near, __global const half* states,
                                     __global const TileReprojection* tiles, __global const LayerTile* layer_tiles) {
  const PastLayers past = {{far, width, height},
                           {alpha, width, height},
                           {near, width, height},
                           states,
                           tiles,
                           layer_tiles,
                           (width + kTemporalTile - 1) / kTemporalTile,
                           (height + kTemporalTile - 1) / kTemporalTile,
                           samples};
  return past;
}

// A texel's state, besides its colours. The confidence of a texel of two layers is stored with a minus sign, even 0.
// The rest is stored in layered tiles only, in four halves, depths as fourth roots: so a half holds them to .2 %.
typedef struct LayerState {
  float far_depth;        // depth of the far layer, or of the only one
  float near_depth;       // 0: there is one layer
  float near_confidence;
  float near_alpha;       // with ALPHA: the near layer's, times its coverage
} LayerState;

static inline LayerState load_state(__global const half* states, int index) {
  const float4 stored = vload_half4(index, states);
  const float4 squared = stored * stored;
  const LayerState state = {squared.x * squared.x, squared.y * squared.y, stored.z, stored.w};
  return state;
}

// Stores the first `count`.
static inline void store_states(__global half* states, int index, int count, LaneFloat far_depth, LaneFloat near_depth,
                                LaneFloat near_confidence, LaneFloat near_alpha) {
  LaneTexels rest = texels_of(sqrt(sqrt(far_depth)), sqrt(sqrt(near_depth)), near_confidence, near_alpha);
#if LANES == 8
  if (count >= kLanes) {
    store_half_texels4(states, index, rest.left);
    store_half_texels4(states, index + 4, rest.right);
    return;
  }
#endif
  for (int i = 0; i < min(count, (int)kLanes); ++i) {
    vstore_half4_rte(first_texel(rest), index + i, states);
    rest = push_texel(rest, first_texel(rest));
  }
}

// Returns the tile of texel (x, y).
static inline int layer_tile_at(const PastLayers* past, int x, int y) {
  const int tile_x = clamp(x / kTemporalTile, 0, past->tiles_x - 1);
  const int tile_y = clamp(y / kTemporalTile, 0, past->tiles_y - 1);
  return tile_y * past->tiles_x + tile_x;
}

static inline float2 phase_of(const PastLayers* past, int tile, LayerKind kind) {
  if (kind == kNearLayer) return (float2)(past->layer_tiles[tile].phase_x, past->layer_tiles[tile].phase_y);
  return (float2)(past->tiles[tile].phase_x, past->tiles[tile].phase_y);
}

// Returns the state of texel (x, y). Where none is stored, the texel has one layer, of the depth of the sample nearest
// to its picture.
static inline LayerState state_at(const PastLayers* past, DEPTH_TEXELS depth, int x, int y) {
  const int tile = layer_tile_at(past, x, y);
  if (past->layer_tiles[tile].is_layered) return load_state(past->states, y * past->far.width + x);
  const HistorySamples samples = past->samples;
  const float2 start = (float2)(samples.start_x, samples.start_y);
  const float2 spacing = (float2)(samples.spacing_x, samples.spacing_y);
  const float2 place = (float2)((float)x + 0.5f, (float)y + 0.5f) + phase_of(past, tile, kFarLayer);
  const int2 at = floor2((place - start) / spacing + 0.5f);
  const int column = clamp(at.x, 0, samples.width - 1), row = clamp(at.y, 0, samples.height - 1);
  const LayerState state = {load_depth(depth, samples.depth, column, row), 0.0f, 0.0f, 0.0f};
  return state;
}

// ---- Rows of four texels.

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

// Loads four texels of a row of the window, counted from 0.
static inline float16 load_row(HistoryLayer layer, TexelWindow window, int row) {
  if (LANES == 8 && window.is_inside) return load_history4(layer, (window.y + row) * layer.width + window.x);
  return load_clamped4(layer, window.x, window.y + row);
}

// Loads their alphas; 1 without ALPHA.
static inline float4 load_alpha_row(AlphaPlane plane, TexelWindow window, int row) {
#if ALPHA
  return load_alpha_clamped4(plane, window.x, window.y + row);
#else
  return (float4)(1.0f);
#endif
}

// The states of four texels.
typedef struct FourStates {
  float4 far_depth, near_depth, near_confidence, near_alpha;
} FourStates;

static inline FourStates load_states(const PastLayers* past, DEPTH_TEXELS depth, TexelWindow window, int row) {
  const float4 none = (float4)(0.0f);
  FourStates states = {none, none, none, none};
  const int x = window.x;
  const int y = window.is_inside ? window.y + row : clamp(window.y + row, 0, past->far.height - 1);
  if (window.has_states) {
    const float16 stored = load_half_texels4(past->states, y * past->far.width + x);
    const float4 far = stored.s048c * stored.s048c, near = stored.s159d * stored.s159d;
    states.far_depth = far * far;
    states.near_depth = near * near;
    states.near_confidence = stored.s26ae;
    states.near_alpha = stored.s37bf;
    return states;
  }
  for (int i = 0; i < 4; ++i) {
    const LayerState state = state_at(past, depth, clamp(x + i, 0, past->far.width - 1), y);
    states.far_depth = (float4)(states.far_depth.yzw, state.far_depth);
    states.near_depth = (float4)(states.near_depth.yzw, state.near_depth);
    states.near_confidence = (float4)(states.near_confidence.yzw, state.near_confidence);
    states.near_alpha = (float4)(states.near_alpha.yzw, state.near_alpha);
  }
  return states;
}

// Loads four texels of the near layer's picture: colours, times coverages, and coverages. A texel of one layer covers
// wholly if it lies before `between`, else not at all.
static inline float16 load_near_row(const PastLayers* past, DEPTH_TEXELS depth, float between, TexelWindow window,
                                    int row) {
  const float16 far = load_row(past->far, window, row);
  const int4 two = as_int4(far.s37bf) < 0;
  float16 near = (float16)(0.0f);
  if (!all(two)) {
    const FourStates states = load_states(past, depth, window, row);
    const float16 covering = select(far, (float16)(1.0f), LAST_CHANNELS);
    near = select(near, covering, OF_FOUR(states.far_depth > between));
  }
  if (any(two)) near = select(near, load_row(past->near, window, row), OF_FOUR(two));
  return near;
}

// Loads 4x4 texels of it.
static inline Neighbourhood load_near_texels(const PastLayers* past, DEPTH_TEXELS depth, float between,
                                             TexelWindow window) {
  const Neighbourhood around = {load_near_row(past, depth, between, window, 0),
                                load_near_row(past, depth, between, window, 1),
                                load_near_row(past, depth, between, window, 2),
                                load_near_row(past, depth, between, window, 3)};
  return around;
}

#if ALPHA
// Loads the alphas of such texels, times coverages.
static inline float4 load_near_alpha_row(const PastLayers* past, DEPTH_TEXELS depth, float between, TexelWindow window,
                                         int row) {
  const int4 two = as_int4(load_row(past->far, window, row).s37bf) < 0;
  const FourStates states = load_states(past, depth, window, row);
  const float4 alone = select((float4)(0.0f), load_alpha_row(past->alpha, window, row), states.far_depth > between);
  return select(alone, states.near_alpha, two);
}

// Resamples them among the 4x4 texels from (x, y) on.
static inline float sample_near_alpha(const PastLayers* past, DEPTH_TEXELS depth, float between, int x, int y,
                                      float4 wx, float4 wy) {
  const TexelWindow window = window_at(past, x, y, 4);
  return blend_alpha_rows(load_near_alpha_row(past, depth, between, window, 0),
                          load_near_alpha_row(past, depth, between, window, 1),
                          load_near_alpha_row(past, depth, between, window, 2),
                          load_near_alpha_row(past, depth, between, window, 3), wx, wy);
}
#endif

// ---- Rows of eight or twelve texels, or single ones.

// Where they lie.
typedef struct RowWindows {
  TexelWindow first, second, third;
  bool has_third;  // there are twelve texels
} RowWindows;

static inline RowWindows windows_from(const PastLayers* past, int x, int y, int rows, bool has_third) {
  RowWindows windows = {window_at(past, x, y, rows), window_at(past, x + 4, y, rows), {0, 0, false, false}, has_third};
  if (has_third) windows.third = window_at(past, x + 8, y, rows);
  return windows;
}

#if LANES == 8
typedef float16 RowFloats;  // twelve texels; the last four lanes are not used, or eight where there is no third window
#else
typedef float RowFloats;  // one texel: a row of four takes more registers than a GPU has
#endif

// Texels by channel.
typedef struct LayerChannels {
  RowFloats red, green, blue, last;
} LayerChannels;

typedef struct LayerRow {
  LayerChannels far;   // or the only one; confidence as stored
  LayerChannels near;  // coverage; 0 in fours of texels of which none has two layers
  RowFloats alpha;     // the far layer's; 1 without ALPHA
  RowFloats far_depth, near_depth, near_confidence, near_alpha;
} LayerRow;

#if LANES == 8
// Returns a row without its first four texels, and with four more after the others, which fill the rest.
static inline RowFloats push_four(RowFloats row, float4 texels) {
  return (float16)(row.s4567, row.s89ab, texels, texels);
}

static inline LayerChannels push_channels(LayerChannels row, float16 texels) {
  const LayerChannels pushed = {push_four(row.red, texels.s048c), push_four(row.green, texels.s159d),
                                push_four(row.blue, texels.s26ae), push_four(row.last, texels.s37bf)};
  return pushed;
}

// Loads a row, whatever the column.
static inline LayerRow load_layer_row(const PastLayers* past, DEPTH_TEXELS depth, RowWindows windows, int row,
                                      int column) {
  const RowFloats none = (RowFloats)(0.0f);
  LayerRow loaded = {{none, none, none, none}, {none, none, none, none}, none, none, none, none, none};
  float16 far = (float16)(0.0f), near = far;
  FourStates states = {none.s0123, none.s0123, none.s0123, none.s0123};
  float4 alpha = none.s0123;
  UNROLL(3)
  for (int i = 0; i < 3; ++i) {
    if (i < 2 || windows.has_third) {
      const TexelWindow window = i == 0 ? windows.first : i == 1 ? windows.second : windows.third;
      far = load_row(past->far, window, row);
      near = any(as_int4(far.s37bf) < 0) ? load_row(past->near, window, row) : (float16)(0.0f);
      states = load_states(past, depth, window, row);
      alpha = load_alpha_row(past->alpha, window, row);
    }
    loaded.far = push_channels(loaded.far, far);
    loaded.near = push_channels(loaded.near, near);
    loaded.alpha = push_four(loaded.alpha, alpha);
    loaded.far_depth = push_four(loaded.far_depth, states.far_depth);
    loaded.near_depth = push_four(loaded.near_depth, states.near_depth);
    loaded.near_confidence = push_four(loaded.near_confidence, states.near_confidence);
    if (ALPHA) loaded.near_alpha = push_four(loaded.near_alpha, states.near_alpha);
  }
  return loaded;
}
#else
// Loads one texel of a row, the one in `column`.
static inline LayerRow load_layer_row(const PastLayers* past, DEPTH_TEXELS depth, RowWindows windows, int row,
                                      int column) {
  const int x = clamp(windows.first.x + column, 0, past->far.width - 1);
  const int y = clamp(windows.first.y + row, 0, past->far.height - 1);
  const int index = y * past->far.width + x;
  const float4 far = load_history(past->far, index);
  const float4 near = as_int(far.w) < 0 ? load_history(past->near, index) : (float4)(0.0f);
  const LayerState state =
      windows.first.has_states ? load_state(past->states, index) : state_at(past, depth, x, y);
#if ALPHA
  const float alpha = load_alpha(past->alpha, index);
#else
  const float alpha = 1.0f;
#endif
  const LayerRow loaded = {{far.x, far.y, far.z, far.w}, {near.x, near.y, near.z, near.w}, alpha,
                           state.far_depth, state.near_depth, state.near_confidence, state.near_alpha};
  return loaded;
}
#endif

// Returns what the pixels that are sampled see in the same column of their neighbourhoods, 0 to 3.
static inline LaneFloat in_column(RowFloats row, int column) {
#if LANES == 8
  if (column == 0) return row.s01234567;
  if (column == 1) return row.s12345678;
  return column == 2 ? row.s23456789 : row.s3456789a;
#else
  return row;
#endif
}
