// SPDX-License-Identifier: MIT
// temporal_tiles: finds how each tile of kTemporalTile^2 output pixels takes history over, and sums the evidence of its
// samples for and against that history.
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
//   splits          in   LAYERS 1: LayerSplit of each split sample
//   marks           in   LAYERS 1: of each tile, not 0 if a sample in it is split
//   previous_layers in   LAYERS 1: LayerTile of each tile, of the previous frame
//   layers          out  LAYERS 1: the same of this frame
//   listed          out  LAYERS 1: the tiles that are layered, in any order
//   tiles           out  TileReprojection of each tile
//   evidence        out  TileEvidence of each tile
//   total           out  TotalLight: grows by each tile's part
//   exposure        in   Exposure of this frame
// Options: MOTION  1 (default) | 0: nothing moves, and all tiles are rigid
//          LAYERS  0 (default) | 1: with MOTION 1; where samples are split, a tile has a near layer, too, with a motion
//                  of its own. Samples of a near layer say nothing of history
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
#include "layers/constants.h"
#include "layers/layer.h"

// ---- The near layer of a tile, and whether texels of two layers may be where a tile comes from.

// Inputs of temporal_tiles that tell of layers.
typedef struct LayerInputs {
  TexelLayout depth;
  __global const float* reprojection;
  __global const LayerSplit* splits;
  __global const int* marks;
  __global const LayerTile* previous;
} LayerInputs;

// Whether a sample of the tile, or of one beside it, is split.
static inline bool is_marked(const TemporalTileParams* params, __global const int* marks, int tile_x, int tile_y) {
  int any = 0;
  for (int y = max(tile_y - 1, 0); y <= min(tile_y + 1, params->tiles_y - 1); ++y) {
    for (int x = max(tile_x - 1, 0); x <= min(tile_x + 1, params->tiles_x - 1); ++x)
      any |= marks[y * params->tiles_x + x];
  }
  return any != 0;
}

// Returns whether a tile between two output positions was split in the previous frame. Also true where they are too
// far apart to look at every tile between them.
static inline bool was_split(const TemporalTileParams* params, __global const LayerTile* previous, float2 from,
                             float2 to) {
  const float2 most = (float2)((float)params->tiles_x, (float)params->tiles_y) - 1.0f;
  const int2 first = convert_int2(clamp(from / (float)kTemporalTile, 0.0f, most));
  const int2 last = convert_int2(clamp(to / (float)kTemporalTile, 0.0f, most));
  if (last.x - first.x > SOURCE_TILES_MAX || last.y - first.y > SOURCE_TILES_MAX) return true;
  int any = 0;
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) any |= previous[y * params->tiles_x + x].is_split;
  }
  return any != 0;
}

// Returns the mean depth of the samples' far, or only, layers.
static inline float mean_depth(const TemporalTileParams* params, DEPTH_TEXELS depth, const LayerInputs* in,
                               SampleRange samples) {
  float sum = 0.0f;
  for (int y = samples.first.y; y <= samples.last.y; ++y) {
    for (int x = samples.first.x; x <= samples.last.x; ++x) {
      const LayerSplit split = in->splits[y * params->frame.width + x];
      sum += is_split_at(params, in->reprojection, x, y) ? split.far_depth : load_depth(depth, in->depth, x, y);
    }
  }
  const int2 count = samples.last - samples.first + 1;
  return sum / (float)(count.x * count.y);
}

// Returns the motion that a rigid tile was found to have.
static inline float2 motion_of(TileReprojection tile) {
  return (float2)(tile.source_phase_x - tile.phase_x - (float)tile.step_x,
                  tile.source_phase_y - tile.phase_y - (float)tile.step_y);
}

// Gives a rigid tile of a thing that was a near layer where it comes from that layer's phase. Returns whether it was
// one.
static inline bool take_near_phase(const TemporalTileParams* params, DEPTH_TEXELS depth, const LayerInputs* in,
                                   SampleRange samples, float2 corner, TileReprojection* tile) {
  const float2 motion = motion_of(*tile);
  const LayerTile before = in->previous[source_tile(params, corner, motion)];
  if (!before.is_split || !(mean_depth(params, depth, in, samples) > before.between)) return false;
  take_phase(tile, (float2)(before.phase_x, before.phase_y), motion);
  return true;
}

// Finds the near layer of a tile's samples and the next ones around it.
static inline LayerTile near_layer_of(const TemporalTileParams* params, const LayerInputs* in, SampleRange around,
                                      float2 corner, __global const TileReprojection* previous_tiles) {
  float2 least = (float2)(65536.0f), most = (float2)(-65536.0f);
  float between = 0.0f, near_depth = 0.0f, count = 0.0f;
  for (int y = around.first.y; y <= around.last.y; ++y) {
    for (int x = around.first.x; x <= around.last.x; ++x) {
      const LayerSplit split = in->splits[y * params->frame.width + x];
      if (!is_split_at(params, in->reprojection, x, y)) continue;
      const float2 motion = (float2)(split.motion_x, split.motion_y);
      least = min(least, motion);
      most = max(most, motion);
      between += between_of(split);
      near_depth += split.near_depth;
      count += 1.0f;
    }
  }
  LayerTile tile = {0.0f, 0.0f, 0.0f, 0.0f, 0, 0, 0};
  if (count == 0.0f) return tile;
  tile.is_split = 1;
  tile.between = between / count;
  tile.motion_range = max(most.x - least.x, most.y - least.y);
  if (!(tile.motion_range <= RIGID_MOTION_RANGE_MAX)) return tile;
  const float2 motion = without_rounding(0.5f * (most + least));
  const int from = source_tile(params, corner, motion);
  const LayerTile before = in->previous[from];
  const bool was_near = before.is_split && near_depth / count > before.between;
  const float2 source_phase = was_near ? (float2)(before.phase_x, before.phase_y)
                                       : (float2)(previous_tiles[from].phase_x, previous_tiles[from].phase_y);
  const float2 phase = carry_phase(source_phase, motion).phase;
  tile.phase_x = phase.x;
  tile.phase_y = phase.y;
  tile.is_rigid = 1;
  return tile;
}

// Finds the layers of a tile whose far layer is `tile`, which may change. Sets `hidden` if history has what the samples
// show as a near layer.
static inline LayerTile layer_tile(const TemporalTileParams* params, DEPTH_TEXELS depth, const LayerInputs* in,
                                   SampleRange samples, ReprojectionRange found, int2 at, float2 corner,
                                   __global const TileReprojection* previous_tiles, TileReprojection* tile,
                                   bool* hidden) {
  LayerTile layers = {0.0f, 0.0f, 0.0f, 0.0f, 0, 0, 0};
  if (is_marked(params, in->marks, at.x, at.y))
    layers = near_layer_of(params, in, widened(params, samples), corner, previous_tiles);
  const float2 scale = (float2)(params->motion_x, params->motion_y);
  const float reach = (float)FETCH_REACH;
  const bool from_split = was_split(params, in->previous, corner + found.least.xy * scale - reach,
                                    corner + (float)kTemporalTile + found.most.xy * scale + reach);
  layers.is_layered = layers.is_split || from_split;
  if (layers.is_split) tile->has_motion_edge = 1;
  *hidden = from_split && (!tile->is_rigid || take_near_phase(params, depth, in, samples, corner, tile));
  return layers;
}

// ---- All tiles.
#endif

// Adds the means of a tile to a sum of such, in units that leave no total beyond an int.
static inline void add_means(TotalLight* sum, const TemporalTileParams* params, TileEvidence tile) {
  const float most = min((float)kLightUnits, 0x1p30f / ((float)params->tiles_x * (float)params->tiles_y));
  const float units = most / max(tile.count, 1.0f);
  sum->light += convert_int(tile.light * units);
  sum->history_error += convert_int(tile.history_error * units);
  sum->neighbour_error += convert_int(tile.neighbour_error * units);
  sum->changed += tile.history_error > CHANGED_TILE_ERROR_MIN * tile.light;
}

// How far history lags behind in tiles of one part of the picture, which a work-item adds to the total at once.
typedef struct PartLag {
  int part;  // -1: none yet
  LagTotal sum;
} PartLag;

static inline void flush_lag(__global TotalLight* total, PartLag lag) {
  if (lag.part < 0) return;
  __global LagTotal* part = &total->lags[lag.part];
  atomic_add(&part->lag, lag.sum.lag);
  atomic_add(&part->lit, lag.sum.lit);
  atomic_add(&part->usual_lag, lag.sum.usual_lag);
  atomic_add(&part->usual_lit, lag.sum.usual_lit);
}

// Adds how far history lags behind in tile (x, y).
static inline void add_lag(PartLag* sum, __global TotalLight* total, const TemporalTileParams* params,
                           TileEvidence tile, int x, int y) {
  if (!(tile.count > 0.0f)) return;
  const int part = y * kLagRows / params->tiles_y * kLagColumns + x * kLagColumns / params->tiles_x;
  if (part != sum->part) {
    flush_lag(total, *sum);
    const PartLag none = {part, {0, 0, 0, 0}};
    *sum = none;
  }
  const float units = lag_units(params->tiles_x, params->tiles_y);
  const float light = tile.lit + LAG_LIGHT_FLOOR * tile.count;
  const float lag = clamp(tile.lag / light, -LAG_MAX, LAG_MAX);
  const int lit = convert_int(units * tile.lit / light);
  sum->sum.lag += convert_int(units * lag);
  sum->sum.lit += lit;
  sum->sum.usual_lag += convert_int(units * clamp(lag, -USUAL_LAG_MAX, USUAL_LAG_MAX));
  if (fabs(lag) < USUAL_LAG_MAX) sum->sum.usual_lit += lit;
}

// Adds the sum of a work-item's tiles to that of the picture.
static inline void add_to_total(__global TotalLight* total, TotalLight sum) {
  atomic_add(&total->light, sum.light);
  atomic_add(&total->history_error, sum.history_error);
  atomic_add(&total->neighbour_error, sum.neighbour_error);
  atomic_add(&total->changed, sum.changed);
}

__kernel void temporal_tiles(const TemporalTileParams params, COLOUR_TEXELS colour, __global const float* reprojection,
                             HISTORY_TEXELS history, __global const TileReprojection* previous_tiles,
                             DEPTH_TEXELS depth, TexelLayout depth_layout, __global const LayerSplit* splits,
                             __global const int* marks, __global const LayerTile* previous_layers,
                             __global LayerTile* layers, __global int* listed, __global TileReprojection* tiles,
                             __global TileEvidence* evidence, __global TotalLight* total,
                             __global const Exposure* exposure) {
  const int first = get_global_id(0) * kTilesAtOnce, tile_y = get_global_id(1);
  if (first >= params.tiles_x || tile_y >= params.tiles_y) return;

  const ExposedFrame frame = expose(params.frame, exposure);
  const float change = exposure->change;
  TotalLight sum = {0, 0, 0, 0, 0, {{0}}};
  PartLag lag = {-1, {0, 0, 0, 0}};
  const HistoryLayer known = {history, params.output_width, params.output_height};
  const Past past = {reprojection, known, previous_tiles, splits, change};
  for (int left = first; left < params.tiles_x; left += (int)get_global_size(0) * kTilesAtOnce) {
    JudgedTile judged[kTilesAtOnce];
    int2 rows = (int2)(0, -1);
    for (int side = 0; side < kTilesAtOnce; ++side) {
      const JudgedTile none = {(int2)(0, -1), false, {.is_rigid = 1, .is_trusted = 1}};
      judged[side] = none;
      const int tile_x = left + side, i = tile_y * params.tiles_x + tile_x;
      if (tile_x >= params.tiles_x) continue;
      const float2 corner = (float2)((float)(tile_x * kTemporalTile), (float)(tile_y * kTemporalTile));
      const SampleRange samples = samples_in_tile(&params, corner);
      TileReprojection tile = none.reprojection;
      bool hidden = false, is_split = false;
#if MOTION
      const ReprojectionRange range = range_of(reprojection, params.reprojection, widened(&params, samples));
      tile = reproject_tile(&params, range, previous_tiles, corner);
#endif
#if LAYERS
      const LayerInputs in = {depth_layout, reprojection, splits, marks, previous_layers};
      const LayerTile own = layer_tile(&params, depth, &in, samples, range, (int2)(tile_x, tile_y), corner,
                                       previous_tiles, &tile, &hidden);
      layers[i] = own;
      if (own.is_layered) listed[atomic_inc(&total->layered)] = i;
      is_split = own.is_split;
#endif
      tiles[i] = tile;
      rows = (int2)(samples.first.y, samples.last.y);
      const JudgedTile whole = {hidden ? (int2)(0, -1) : (int2)(samples.first.x, samples.last.x), is_split, tile};
      judged[side] = whole;  // rusticl 22.3 copies a struct wrong where only some items do
    }
    TileEvidence evidence_of[kTilesAtOnce];
    UNROLL_ALWAYS(kTilesAtOnce)
    for (int side = 0; side < kTilesAtOnce; ++side) evidence_of[side] = no_evidence();
    judge_tiles(evidence_of, judged, colour, &frame, depth, depth_layout, &past, &params, rows);
    UNROLL_ALWAYS(kTilesAtOnce)  // an index would put the evidence in memory
    for (int side = 0; side < kTilesAtOnce; ++side) {
      if (left + side >= params.tiles_x) continue;
      add_means(&sum, &params, evidence_of[side]);
      add_lag(&lag, total, &params, evidence_of[side], left + side, tile_y);
      evidence[tile_y * params.tiles_x + left + side] = evidence_of[side];
    }
  }
  flush_lag(total, lag);
  add_to_total(total, sum);
}
