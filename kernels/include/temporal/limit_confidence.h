// SPDX-License-Identifier: MIT
// How far fetched history is to be believed, and in which light it is taken: eight output pixels of one row and one
// tile at a time.
#pragma once

#include "motion/motion_edge.h"
#include "temporal/constants.h"
#include "temporal/fetch_history.h"

// Evidence about history: how much it is worth.
typedef struct Evidence {
  float8 confidence;  // within [0, CONFIDENCE_MAX]
  float8 rejection;   // within [0, 1]: how far history is to be brought into the range of this frame's samples
} Evidence;

// Returns the most confidence for a trust in [0, 1]: all of it for 1, 0 for 0.
static inline float8 most_confidence(float8 trust) {
  return trust / (1.0f + 1.0f / CONFIDENCE_MAX - trust);
}

// Returns how far between texels a place lies: 0 on one, 1 half-way between four and near there.
static inline float8 between_texels(float8 fraction_x, float8 fraction_y) {
  return min(4.0f * (fraction_x * (1.0f - fraction_x) + fraction_y * (1.0f - fraction_y)), 1.0f);
}

// Limits confidence by what resampling costs.
static inline float8 after_resampling(float8 confidence, float8 between) {
  return confidence / (1.0f + RESAMPLING_COST * between * confidence);
}

// Returns the evidence of history from which nothing is taken.
static inline Evidence full_evidence(const FetchedHistory* history) {
  const Evidence evidence = {history->confidence, (float8)(0.0f)};
  return evidence;
}

// Limits confidence by what resampling, disocclusion, reactive values and motion edges leave of it.
static inline Evidence limit_confidence(const FetchedHistory* history, const EightReprojections* motion) {
  const float8 between = between_texels(history->fraction_x, history->fraction_y);
  float8 w = after_resampling(history->confidence, between);
  w = select(w, min(w, RESAMPLED_CONFIDENCE_MAX), between > RESAMPLED_MIN);
  const float8 trust = motion->trust;
  w = min(w, most_confidence(trust));
  w = w / (1.0f + EDGE_COST * smooth_step(motion->motion_edge, COSTLY_EDGE_MIN, COSTLY_EDGE_MAX) * w);
  const Evidence evidence = {w, max(1.0f - trust, edge_rejection(motion->motion_edge))};
  return evidence;
}

// ---- Relighting: the gain and rejection that temporal_light found for each tile, blended between tiles.

// The light at one place of a tile's edge.
typedef struct EdgeLight {
  float rejection, gain;
} EdgeLight;

// The same where light has not changed.
#define EVEN_LIGHT ((EdgeLight){0.0f, 1.0f})

// Returns the light at the left edge of pixel (x, y), the first column of a tile: bilinear between the four tiles
// around.
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

// Returns whether no tile of a column of three, the middle one at (tile_x, tile_y), has a change of light; clamped to
// the edge.
static inline bool has_even_light(__global const TileLight* light, const TemporalParams* params, int tile_x,
                                  int tile_y) {
  __global const TileLight* column = light + clamp(tile_x, 0, params->tiles_x - 1);
  __global const TileLight* above = column + max(tile_y - 1, 0) * params->tiles_x;
  __global const TileLight* own = column + tile_y * params->tiles_x;
  __global const TileLight* below = column + min(tile_y + 1, params->tiles_y - 1) * params->tiles_x;
  return !(above->rejection + own->rejection + below->rejection > 0.0f) && above->gain == 1.0f && own->gain == 1.0f &&
         below->gain == 1.0f;
}

// Interpolates from a tile's left edge to its right, at the centres of its eight columns.
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

// Returns history in this frame's light.
static inline EightTexels relight(EightTexels history, EdgeLight left, EdgeLight right) {
  if (left.gain == 1.0f && right.gain == 1.0f) return history;
  const float8 gain = ramp(left.gain, right.gain);
  const EightTexels relit = {history.left * to_four_texels(gain.lo), history.right * to_four_texels(gain.hi)};
  return relit;
}
