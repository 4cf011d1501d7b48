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
#include "temporal/constants.h"
#include "temporal/judge_samples.h"
#include "temporal/reproject_tile.h"
#include "temporal/temporal_params.h"
#include "texel.h"

#if LAYERS < 0 || LAYERS > MOTION
#error "LAYERS must be 0 or, with MOTION 1, 1"
#endif
#if LAYERS
#include "layers/layer_tile.h"
#endif

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
    if (!hidden) found_evidence = judge_history(colour, depth, depth_layout, &past, &params, tile, samples);
    add_means(&sum, &params, found_evidence);
    tiles[i] = tile;
    evidence[i] = found_evidence;
  }
  add_to_total(total, sum);
}
