// SPDX-License-Identifier: MIT
// History of two layers, and what its texels are.
#pragma once

#include "layers/layer.h"
#include "temporal/fetch_history.h"
#include "temporal/history_alpha.h"

// The previous frame's layers.
typedef struct PastLayers {
  HistoryLayer far;                        // colour and confidence
  AlphaPlane alpha;                        // with ALPHA: the far layer's
  HistoryLayer near;                       // premultiplied colour and coverage
  __global const half* states;             // see LayerState
  __global const TileReprojection* tiles;  // of the far layer
  __global const LayerTile* layer_tiles;
  int tiles_x, tiles_y;
  // Where the samples of that frame lie: sample i at (i * spacing + start), output pixels.
  int width, height;
  float2 spacing, start;
} PastLayers;

// What a texel is, besides its colours. The confidence of a texel of two layers is stored with a minus sign, even 0.
// The rest is stored in layered tiles only, in four halves, depths as fourth roots: so a half holds them to .2 %.
typedef struct LayerState {
  float far_depth;        // of what the far layer, or the only one, shows
  float near_depth;       // 0: there is one layer
  float near_confidence;
} LayerState;

static inline float between_layers(LayerState state) {
  return 0.5f * (state.far_depth + state.near_depth);
}

static inline LayerState load_state(__global const half* states, int index) {
  const float4 stored = vload_half4(index, states);
  const float4 squared = stored * stored;
  const LayerState state = {squared.x * squared.x, squared.y * squared.y, stored.z};
  return state;
}

// The first `count` of eight.
static inline void store_states(__global half* states, int index, int count, float8 far_depth, float8 near_depth,
                                float8 near_confidence) {
  const float8 far = sqrt(sqrt(far_depth)), near = sqrt(sqrt(near_depth));
  const float16 left = (float16)(far.s0, near.s0, near_confidence.s0, 0.0f, far.s1, near.s1, near_confidence.s1, 0.0f,
                                 far.s2, near.s2, near_confidence.s2, 0.0f, far.s3, near.s3, near_confidence.s3, 0.0f);
  const float16 right = (float16)(far.s4, near.s4, near_confidence.s4, 0.0f, far.s5, near.s5, near_confidence.s5, 0.0f,
                                  far.s6, near.s6, near_confidence.s6, 0.0f, far.s7, near.s7, near_confidence.s7, 0.0f);
  if (count >= 8) {
    store_half_texels4(states, index, left);
    store_half_texels4(states, index + 4, right);
    return;
  }
  float4 state[8];
  vstore16(left, 0, (float*)state);
  vstore16(right, 1, (float*)state);
  for (int i = 0; i < count; ++i) vstore_half4_rte(state[i], index + i, states);
}

static inline int layer_tile_at(const PastLayers* past, int x, int y) {
  const int tile_x = clamp(x / kTemporalTile, 0, past->tiles_x - 1);
  const int tile_y = clamp(y / kTemporalTile, 0, past->tiles_y - 1);
  return tile_y * past->tiles_x + tile_x;
}

// Of texel (x, y). Where nothing was stored, it shows what the sample nearest to its picture does.
static inline LayerState state_at(const PastLayers* past, DEPTH_TEXELS depth, TexelLayout layout, int x, int y) {
  const int tile = layer_tile_at(past, x, y);
  if (past->layer_tiles[tile].is_layered) return load_state(past->states, y * past->far.width + x);
  const float2 phase = (float2)(past->tiles[tile].phase_x, past->tiles[tile].phase_y);
  const float2 place = (float2)((float)x + 0.5f, (float)y + 0.5f) + phase;
  const float2 at = floor((place - past->start) / past->spacing + 0.5f);
  const int column = clamp((int)at.x, 0, past->width - 1), row = clamp((int)at.y, 0, past->height - 1);
  const LayerState state = {load_depth(depth, layout, column, row), 0.0f, 0.0f};
  return state;
}
