// SPDX-License-Identifier: MIT
// The near layer of a tile, and whether texels of two layers may be where a tile comes from.
#pragma once

#include "layers/constants.h"
#include "layers/layer.h"
#include "temporal/constants.h"
#include "temporal/reproject_tile.h"

// Inputs of temporal_tiles that tell of layers.
typedef struct LayerInputs {
  TexelLayout depth;
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
  const float2 first = clamp(floor(from / (float)kTemporalTile), 0.0f, most);
  const float2 last = clamp(floor(to / (float)kTemporalTile), 0.0f, most);
  if (last.x - first.x > (float)SOURCE_TILES_MAX || last.y - first.y > (float)SOURCE_TILES_MAX) return true;
  int any = 0;
  for (int y = (int)first.y; y <= (int)last.y; ++y) {
    for (int x = (int)first.x; x <= (int)last.x; ++x) any |= previous[y * params->tiles_x + x].is_split;
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
      sum += is_split(split) ? split.far_depth : load_depth(depth, in->depth, x, y);
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
      if (!is_split(split)) continue;
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
