// SPDX-License-Identifier: MIT
// Relighting: what temporal_light found of each tile is blended between tiles, and applied to eight output pixels of a
// row.
#pragma once

#include "temporal/limit_confidence.h"

// At one place of a tile's edge.
typedef struct EdgeLight {
  float rejection, gain;
} EdgeLight;

// Where light has not changed.
#define EVEN_LIGHT ((EdgeLight){0.0f, 1.0f})

// At the left edge of pixel (x, y), the first column of a tile: bilinear between the four tiles around it.
static inline EdgeLight light_at_edge(__global const TileLight* light, const TemporalParams* params, int x, int y) {
  const int right = min(x / kTemporalTile, params->tiles_x - 1), left = max(x / kTemporalTile - 1, 0);
  const int middle = y - kTemporalTile / 2;
  const int above = max(middle, 0) / kTemporalTile, below = min(above + 1, params->tiles_y - 1);
  const float down = middle < 0 ? 0.0f : ((float)(middle % kTemporalTile) + 0.5f) / (float)kTemporalTile;
  __global const TileLight* upper = light + above * params->tiles_x;
  __global const TileLight* lower = light + below * params->tiles_x;
  const float2 upper_mean =
      0.5f * (float2)(upper[left].rejection + upper[right].rejection, upper[left].gain + upper[right].gain);
  const float2 lower_mean =
      0.5f * (float2)(lower[left].rejection + lower[right].rejection, lower[left].gain + lower[right].gain);
  const float2 mean = upper_mean + (lower_mean - upper_mean) * down;
  const EdgeLight edge = {mean.x, mean.y};
  return edge;
}

// Whether no tile of a column of three, the middle one at (tile_x, tile_y), has a change of light; clamped to the edge.
static inline bool has_even_light(__global const TileLight* light, const TemporalParams* params, int tile_x,
                                  int tile_y) {
  __global const TileLight* column = light + clamp(tile_x, 0, params->tiles_x - 1);
  __global const TileLight* above = column + max(tile_y - 1, 0) * params->tiles_x;
  __global const TileLight* own = column + tile_y * params->tiles_x;
  __global const TileLight* below = column + min(tile_y + 1, params->tiles_y - 1) * params->tiles_x;
  return !(above->rejection + own->rejection + below->rejection > 0.0f) && above->gain == 1.0f && own->gain == 1.0f &&
         below->gain == 1.0f;
}

// From a tile's left edge to its right, at the centres of its eight columns.
static inline float8 ramp(float left, float right) {
  return left + (right - left) * (float8)(0.0625f, 0.1875f, 0.3125f, 0.4375f, 0.5625f, 0.6875f, 0.8125f, 0.9375f);
}

// Limits confidence by the tiles' rejection, too.
static inline void reject_by_light(Evidence* evidence, EdgeLight left, EdgeLight right) {
  if (!(left.rejection + right.rejection > 0.0f)) return;
  const float8 rejection = ramp(left.rejection, right.rejection);
  evidence->rejection = max(evidence->rejection, rejection);
  evidence->confidence = min(evidence->confidence, most_confidence(1.0f - rejection));
}

// History in this frame's light.
static inline EightTexels relight(EightTexels history, EdgeLight left, EdgeLight right) {
  if (left.gain == 1.0f && right.gain == 1.0f) return history;
  const float8 gain = ramp(left.gain, right.gain);
  const EightTexels relit = {history.left * to_four_texels(gain.lo), history.right * to_four_texels(gain.hi)};
  return relit;
}
