// SPDX-License-Identifier: MIT
// temporal_tiles: how history is taken over in each tile of kTemporalTile^2 output pixels, and what the tile's samples
// say of it.
//   A tile is rigid if its samples, and the next ones around it, move alike within .05 output pixels. With r the phase
//   of the previous tile that its middle comes from and v the way that it has come, both in output pixels, it takes
//   texels round(r + v) away and has the phase r + v - round(r + v).
//   The evidence (see TileEvidence) is sums over its samples; those that are not trusted do not count.
//
//   params          in   viewport, layouts, scales
//   colour          in   RGBA16F or RGBA32F, viewport
//   reprojection    in   MOTION 1: Reprojection of each sample, from reproject with MOTION_EDGE 1
//   history         in   the layer of the previous frame
//   previous_tiles  in   TileReprojection of each tile, of the previous frame
//   depth           in   LAYERS 1: R32F, viewport
//   splits          in   LAYERS 1: LayerSplit of each sample
//   marks           in   LAYERS 1: of each tile, not 0 if a sample in it is split
//   previous_layers in   LAYERS 1: LayerTile of each tile, of the previous frame
//   layers          out  LAYERS 1: the same of this frame
//   tiles           out  TileReprojection of each tile
//   evidence        out  TileEvidence of each tile
//   total           out  TotalLight: grows by each tile's part
// Options: MOTION  1 (default) | 0: nothing moves, and all tiles are rigid
//          LAYERS  0 (default) | 1: with MOTION 1; where samples are split, a tile has a near layer, too, with a motion
//                  of its own (layers/layer_tile.h). Samples of a near layer say nothing of history
//          SOURCE_STORAGE, SOURCE_FORMAT as in texel.h, HISTORY_FORMAT as in temporal/history.h
// Reference: tests/reference/temporal_tiles.cpp; of layers tests/reference/layer_tile.cpp
#include "layers/layer.h"
#include "temporal/constants.h"
#include "temporal/frame_samples.h"
#include "temporal/history.h"
#include "temporal/reproject_tile.h"
#include "temporal/temporal_params.h"
#include "texel.h"

#ifndef LAYERS
#define LAYERS 0
#endif
#if LAYERS < 0 || LAYERS > MOTION
#error "LAYERS must be 0 or, with MOTION 1, 1"
#endif
#if LAYERS
#include "layers/layer_tile.h"
#endif

enum { kJudgedAhead = 4 * kTemporalTile, kColourAhead = 16 };  // texels of history and samples to prefetch

// The previous frame, as far as it is known, and how to get there.
typedef struct Past {
  __global const float* reprojection;
  HistoryLayer history;
  __global const TileReprojection* previous_tiles;
  __global const LayerSplit* splits;  // one for each sample of a split tile, else null
} Past;

static inline float luma(float4 colour) {
  return max(0.25f * (colour.x + colour.z) + 0.5f * colour.y, 0.0f);
}

// The place of sample (x, y) in the previous history, output pixels; false if the sample is not trusted.
static inline bool find_in_history(const Past* past, const TemporalTileParams* params, TileReprojection tile, int x,
                                   int y, float2* at) {
  float at_x = (float)x * params->spacing_x + params->start_x;
  float at_y = (float)y * params->spacing_y + params->start_y;
#if MOTION
  const float4 found = vload4(texel_index(params->reprojection, x, y), past->reprojection);
  if (!(found.z > JUDGING_TRUST_MIN)) return false;
  if (!tile.is_rigid) {
    at_x += found.x * params->motion_x;
    at_y += found.y * params->motion_y;
    const int source = tile_at(params, at_x, at_y);
    at_x -= past->previous_tiles[source].phase_x;
    at_y -= past->previous_tiles[source].phase_y;
  }
#endif
  if (tile.is_rigid) {
    at_x -= tile.phase_x + (float)tile.step_x;
    at_y -= tile.phase_y + (float)tile.step_y;
  }
  *at = (float2)(at_x, at_y);
  return true;
}

// Whether sample (x, y) shows a near layer, of which the layer of history that is judged knows nothing.
static inline bool is_of_near_layer(const Past* past, const TemporalTileParams* params, DEPTH_TEXELS depth,
                                    TexelLayout layout, int x, int y) {
#if LAYERS
  if (past->splits == 0) return false;
  const LayerSplit split = past->splits[y * params->frame.width + x];
  return is_split(split) && !(load_depth(depth, layout, x, y) < between_of(split));
#else
  return false;
#endif
}

// Returns which of its tile's cells sample (x, y) lies in.
static inline int cell_of(const TemporalTileParams* params, int x, int y) {
  const int column = (int)((float)x * params->spacing_x + params->start_x) % kTemporalTile;
  const int row = (int)((float)y * params->spacing_y + params->start_y) % kTemporalTile;
  return 2 * (row / kTemporalCell) + column / kTemporalCell;
}

// Adds what sample (x, y) says of history.
static inline void judge_sample(TileEvidence* evidence, COLOUR_TEXELS colour, DEPTH_TEXELS depth,
                                TexelLayout depth_layout, const Past* past, const TemporalTileParams* params,
                                TileReprojection tile, int x, int y) {
  float2 at;
  if (is_of_near_layer(past, params, depth, depth_layout, x, y)) return;
  if (!find_in_history(past, params, tile, x, y, &at)) return;
  const int width = params->output_width, height = params->output_height;
  if (!(at.x >= 0.0f && at.y >= 0.0f && at.x < (float)width && at.y < (float)height)) return;
  const int index = (int)at.y * width + (int)at.x;
  will_read_history(past->history, index + kJudgedAhead);
  const float4 before = load_history(past->history, index);
  const float4 sample = sample_at(colour, &params->frame, x, y);
  if (fabs(before.w) < JUDGED_CONFIDENCE_MIN || !is_valid(sample)) return;

  const int aside = params->parity >= 0 ? 1 : 0;  // the shaded neighbours on a checkerboard are the diagonal ones
  const float4 left = sample_at(colour, &params->frame, x - 1, y - aside);
  const float4 right = sample_at(colour, &params->frame, x + 1, y + aside);
  const float4 above = sample_at(colour, &params->frame, x + aside, y - 1);
  const float4 below = sample_at(colour, &params->frame, x - aside, y + 1);
  const float4 around = 0.25f * (left + right + above + below);
  const float own = luma(sample), known = luma(before);
  const float scale = 1.0f / (1.0f + own + known);
  const float change = (own - known) * scale;
  const float brighter = (change > LUMA_CHANGE_MIN ? 1.0f : 0.0f) - (change < -LUMA_CHANGE_MIN ? 1.0f : 0.0f);
  evidence->brightening += change;
  evidence->light += known * scale;
  evidence->history_error += fabs(change);
  const float beside = luma(around);
  evidence->neighbour_error += is_valid(around) ? fabs(own - beside) / (1.0f + own + beside) : 0.0f;
  evidence->brighter += brighter;
  evidence->count += 1.0f;
  CellEvidence* cell = &evidence->cells[cell_of(params, x, y)];
  cell->brightening += change;
  cell->brighter += brighter;
  cell->count += 1.0f;
  const OutlierRange range = outlier_range(before);
  if (!is_outlier(sample, range)) return;
  const int outliers_beside =
      (is_valid(left) && is_outlier(left, range)) + (is_valid(right) && is_outlier(right, range)) +
      (is_valid(above) && is_outlier(above, range)) + (is_valid(below) && is_outlier(below, range));
  evidence->outliers += outliers_beside >= 2 ? 1.0f : 0.0f;
}

static inline TileEvidence gather_evidence(COLOUR_TEXELS colour, DEPTH_TEXELS depth, TexelLayout depth_layout,
                                           const Past* past, const TemporalTileParams* params, TileReprojection tile,
                                           SampleRange samples) {
  const int2 first = samples.first, last = samples.last;
  // On a checkerboard every second sample is shaded.
  const int apart = params->parity >= 0 ? 2 : 1;
  TileEvidence evidence = no_evidence();
  for (int y = first.y - 1; y <= last.y + 1; ++y)
    will_read_colour(colour, params->frame.colour, last.x + kColourAhead, y);
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x + (apart == 2 ? (first.x + y + params->parity) & 1 : 0); x <= last.x; x += apart)
      judge_sample(&evidence, colour, depth, depth_layout, past, params, tile, x, y);
  }
  return evidence;
}

// Adds the means of a tile to a sum of such, in units that leave no total beyond an int.
static inline void add_means(TotalLight* sum, const TemporalTileParams* params, TileEvidence tile) {
  const float most = min((float)kLightUnits, 0x1p30f / ((float)params->tiles_x * (float)params->tiles_y));
  const float units = most / max(tile.count, 1.0f);
  sum->brightening += convert_int(tile.brightening * units);
  sum->change += convert_int(fabs(tile.brightening) * units);
  sum->light += convert_int(tile.light * units);
  sum->history_error += convert_int(tile.history_error * units);
  sum->neighbour_error += convert_int(tile.neighbour_error * units);
  sum->changed += tile.history_error > CHANGED_TILE_ERROR_MIN * tile.light;
}

// Adds the sum of a work-item's tiles to that of the picture.
static inline void add_to_total(__global TotalLight* total, TotalLight sum) {
  atomic_add(&total->brightening, sum.brightening);
  atomic_add(&total->change, sum.change);
  atomic_add(&total->light, sum.light);
  atomic_add(&total->history_error, sum.history_error);
  atomic_add(&total->neighbour_error, sum.neighbour_error);
  atomic_add(&total->changed, sum.changed);
}

__kernel void temporal_tiles(const TemporalTileParams params, COLOUR_TEXELS colour, __global const float* reprojection,
                             HISTORY_TEXELS history, __global const TileReprojection* previous_tiles,
                             DEPTH_TEXELS depth, TexelLayout depth_layout, __global const LayerSplit* splits,
                             __global const int* marks, __global const LayerTile* previous_layers,
                             __global LayerTile* layers, __global TileReprojection* tiles,
                             __global TileEvidence* evidence, __global TotalLight* total) {
  const int first = get_global_id(0), tile_y = get_global_id(1);
  if (first >= params.tiles_x || tile_y >= params.tiles_y) return;

  TotalLight sum = {0, 0, 0, 0, 0, 0};
  for (int tile_x = first; tile_x < params.tiles_x; tile_x += (int)get_global_size(0)) {
    const float2 corner = (float2)((float)(tile_x * kTemporalTile), (float)(tile_y * kTemporalTile));
    const SampleRange samples = samples_in_tile(&params, corner);
#if MOTION
    const ReprojectionRange found = range_of(reprojection, params.reprojection, widened(&params, samples));
    TileReprojection tile = reproject_tile(&params, found, previous_tiles, corner);
#else
    const TileReprojection tile = {.is_rigid = 1, .is_trusted = 1};
#endif
    const int i = tile_y * params.tiles_x + tile_x;
    bool hidden = false, is_split = false;
#if LAYERS
    const LayerInputs in = {depth_layout, splits, marks, previous_layers};
    const LayerTile own = layer_tile(&params, depth, &in, samples, found, (int2)(tile_x, tile_y), corner,
                                     previous_tiles, &tile, &hidden);
    layers[i] = own;
    is_split = own.is_split;
#endif
    const HistoryLayer known = {history, params.output_width, params.output_height};
    const Past past = {reprojection, known, previous_tiles, is_split ? splits : 0};
    TileEvidence found_evidence = no_evidence();
    if (!hidden) found_evidence = gather_evidence(colour, depth, depth_layout, &past, &params, tile, samples);
    add_means(&sum, &params, found_evidence);
    tiles[i] = tile;
    evidence[i] = found_evidence;
  }
  add_to_total(total, sum);
}
