// SPDX-License-Identifier: MIT
// Limits the confidence of fetched history, and applies the gain of its light: output pixels of one row and one
// tile.
#pragma once

#include "motion/motion_edge.h"
#include "temporal/constants.h"
#include "temporal/fetch_history.h"

// Evidence about history: how much it is worth.
typedef struct Evidence {
  LaneFloat confidence;  // within [0, CONFIDENCE_MAX]
  LaneFloat rejection;   // within [0, 1]: how far history is to be brought into the range of this frame's samples
} Evidence;

// Returns the most confidence for a trust in [0, 1]: all of it for 1, 0 for 0.
static inline LaneFloat most_confidence(LaneFloat trust) {
  return trust / (1.0f + 1.0f / CONFIDENCE_MAX - trust);
}

// Returns how far between texels a place lies: 0 on one, 1 half-way between four and near there.
static inline LaneFloat between_texels(LaneFloat fraction_x, LaneFloat fraction_y) {
  return min(4.0f * (fraction_x * (1.0f - fraction_x) + fraction_y * (1.0f - fraction_y)), 1.0f);
}

// Limits confidence by what resampling costs.
static inline LaneFloat after_resampling(LaneFloat confidence, LaneFloat between) {
  return confidence / (1.0f + RESAMPLING_COST * between * confidence);
}

// Returns the evidence of history from which nothing is taken.
static inline Evidence full_evidence(const FetchedHistory* history) {
  const Evidence evidence = {history->confidence, (LaneFloat)(0.0f)};
  return evidence;
}

// Limits confidence by what resampling, disocclusion, reactive values and motion edges leave of it.
static inline Evidence limit_confidence(const FetchedHistory* history, const Reprojections* motion) {
  const LaneFloat between = between_texels(history->fraction_x, history->fraction_y);
  LaneFloat w = after_resampling(history->confidence, between);
  w = select(w, min(w, RESAMPLED_CONFIDENCE_MAX), between > RESAMPLED_MIN);
  const LaneFloat trust = motion->trust;
  w = min(w, most_confidence(trust));
  w = w / (1.0f + EDGE_COST * smooth_step(motion->motion_edge, COSTLY_EDGE_MIN, COSTLY_EDGE_MAX) * w);
  const Evidence evidence = {w, max(1.0f - trust, edge_rejection(motion->motion_edge))};
  return evidence;
}

// ---- Relighting: the gain that temporal_light found for each tile, blended between tiles, and the rejection that it
// found for each cell, blended between cells.

// What pixels of a row, those of one tile, are to make of it.
typedef struct RowLight {
  float4 rejection;             // at the centres of four cells: the tile's two, and one on each side
  float left_gain, right_gain;  // at the tile's edges
  int column;                   // of the tile: that of the first pixel
} RowLight;

// The same where light has not changed.
static inline RowLight even_light(void) {
  const RowLight light = {(float4)(0.0f), 1.0f, 1.0f, 0};
  return light;
}

// A row between two, and how far it is from the upper one to the lower.
typedef struct RowBlend {
  int above, below;
  float down;
} RowBlend;

// Row y between the centres of rows of blocks of `size` pixels, the last of which is row `last`.
static inline RowBlend between_rows(int y, int size, int last) {
  const int middle = y - size / 2;
  const int above = max(middle, 0) / size;
  const float down = middle < 0 ? 0.0f : ((float)(middle % size) + 0.5f) / (float)size;
  const RowBlend between = {above, min(above + 1, last), down};
  return between;
}

static inline float rejection_of_cell(__global const TileLight* light, const TemporalParams* params, int x, int y) {
  const int cell_x = clamp(x, 0, 2 * params->tiles_x - 1);
  return light[y / 2 * params->tiles_x + cell_x / 2].cells[2 * (y % 2) + cell_x % 2].rejection;
}

// Those of row y of cells, from the one left of tile_x on.
static inline float4 rejections_of_row(__global const TileLight* light, const TemporalParams* params, int tile_x,
                                       int y) {
  return (float4)(rejection_of_cell(light, params, 2 * tile_x - 1, y), rejection_of_cell(light, params, 2 * tile_x, y),
                  rejection_of_cell(light, params, 2 * tile_x + 1, y),
                  rejection_of_cell(light, params, 2 * tile_x + 2, y));
}

// Returns the mean gains of row tile_y of tiles at both edges of tile_x.
static inline float2 gains_of_row(__global const TileLight* light, const TemporalParams* params, int tile_x,
                                  int tile_y) {
  __global const TileLight* row = light + tile_y * params->tiles_x;
  const float own = row[tile_x].gain;
  return 0.5f * (float2)(row[max(tile_x - 1, 0)].gain + own, own + row[min(tile_x + 1, params->tiles_x - 1)].gain);
}

// Returns the light of the pixels from (x, y) on, where the exposure has changed by a factor.
static inline RowLight light_of_row(__global const TileLight* light, const TemporalParams* params, float change, int x,
                                    int y) {
  const int tile_x = x / kTemporalTile;
  const RowBlend cells = between_rows(y, kTemporalCell, 2 * params->tiles_y - 1);
  const RowBlend tiles = between_rows(y, kTemporalTile, params->tiles_y - 1);
  const float4 upper = rejections_of_row(light, params, tile_x, cells.above);
  const float2 gains = gains_of_row(light, params, tile_x, tiles.above);
  const float2 gain = gains + (gains_of_row(light, params, tile_x, tiles.below) - gains) * tiles.down;
  const RowLight row = {upper + (rejections_of_row(light, params, tile_x, cells.below) - upper) * cells.down,
                        gain.x * change, gain.y * change, x % kTemporalTile};
  return row;
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

// Interpolates from a tile's left edge to its right, at the centres of the pixels' columns.
static inline LaneFloat ramp(RowLight light) {
  const LaneFloat along = 0.125f * to_lane_float(light.column + LANE_NUMBERS) + 0.0625f;
  return light.left_gain + (light.right_gain - light.left_gain) * along;
}

// Interpolates between the centres of four cells, at the centres of the pixels' columns.
static inline LaneFloat ramp_cells(RowLight light) {
#if LANES == 8
  const LaneFloat along = (LaneFloat)(0.625f, 0.875f, 0.125f, 0.375f, 0.625f, 0.875f, 0.125f, 0.375f);
  const LaneFloat left = light.rejection.s00111122, right = light.rejection.s11222233;
#else
  const float at = 0.25f * (float)light.column + 0.625f;  // 0 at the first of the four
  const float4 cells = at < 1.0f ? light.rejection : at < 2.0f ? light.rejection.yzww : light.rejection.zwww;
  const float along = at - floor(at), left = cells.x, right = cells.y;
#endif
  return left + (right - left) * along;
}

// Limits confidence by the cells' rejection, too.
static inline void reject_by_light(Evidence* evidence, RowLight light) {
  if (!(light.rejection.x + light.rejection.y + light.rejection.z + light.rejection.w > 0.0f)) return;
  const LaneFloat rejection = ramp_cells(light);
  evidence->rejection = max(evidence->rejection, rejection);
  evidence->confidence = min(evidence->confidence, most_confidence(1.0f - rejection));
}

// Returns history in this frame's light.
static inline LaneTexels relight(LaneTexels history, RowLight light) {
  if (light.left_gain == 1.0f && light.right_gain == 1.0f) return history;
  return times(history, ramp(light));
}
