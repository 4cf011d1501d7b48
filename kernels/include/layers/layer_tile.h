// SPDX-License-Identifier: MIT
// The near layer of a tile, and whether a tile has to do with two layers at all.
#pragma once

#include "layers/split.h"
#include "temporal/reproject_tile.h"

enum {
  kFetchReach = 3,   // texels around the place of a pixel in the previous frame that fetching may read
  kFarthestTile = 8  // tiles: where samples of one tile come from places farther apart, layers are not looked for
};

// What temporal_tiles reads and knows of layers.
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

// Whether a tile between two output positions was split in the previous frame.
static inline bool was_split(const TemporalTileParams* params, __global const LayerTile* previous, float2 from,
                             float2 to) {
  const float2 most = (float2)((float)params->tiles_x, (float)params->tiles_y) - 1.0f;
  const float2 first = clamp(floor(from / (float)kTemporalTile), 0.0f, most);
  const float2 last = clamp(floor(to / (float)kTemporalTile), 0.0f, most);
  if (last.x - first.x > (float)kFarthestTile || last.y - first.y > (float)kFarthestTile) return true;
  int any = 0;
  for (int y = (int)first.y; y <= (int)last.y; ++y) {
    for (int x = (int)first.x; x <= (int)last.x; ++x) any |= previous[y * params->tiles_x + x].is_split;
  }
  return any != 0;
}

// Of the far, or only, layer.
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

// The phase of what a tile takes over that moves by `motion`: place = source phase - motion, without whole texels.
static inline float2 phase_after(float2 source_phase, float2 motion) {
  const float2 place = source_phase - motion;
  return place - floor(place + 0.5f);
}

static inline float2 settled(float2 motion) {
  return select(motion, (float2)(0.0f), fabs(motion) < (float2)(STILL_MOTION));
}

// Where the middle of the tile was, as a tile of the previous frame.
static inline int source_tile(const TemporalTileParams* params, float2 corner, float2 motion) {
  const float2 source = corner + 0.5f * (float)kTemporalTile + motion;
  return tile_at(params, source.x, source.y);
}

// The motion that a rigid tile was found to have.
static inline float2 motion_of(TileReprojection tile) {
  return (float2)(tile.source_phase_x - tile.phase_x - (float)tile.step_x,
                  tile.source_phase_y - tile.phase_y - (float)tile.step_y);
}

// A rigid tile of a thing that was a near layer where it comes from goes on with that layer's phase. Returns whether
// it does.
static inline bool take_near_phase(const TemporalTileParams* params, DEPTH_TEXELS depth, const LayerInputs* in,
                                   SampleRange samples, float2 corner, TileReprojection* tile) {
  const float2 motion = motion_of(*tile);
  const LayerTile before = in->previous[source_tile(params, corner, motion)];
  if (!before.is_split || !(mean_depth(params, depth, in, samples) > before.between)) return false;
  const float2 place = (float2)(before.phase_x, before.phase_y) - motion;
  const float2 step = floor(place + 0.5f);
  tile->source_phase_x = before.phase_x;
  tile->source_phase_y = before.phase_y;
  tile->phase_x = place.x - step.x;
  tile->phase_y = place.y - step.y;
  tile->step_x = (int)step.x;
  tile->step_y = (int)step.y;
  return true;
}

// The near layer of a tile's samples and the next ones around it.
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
  if (!(tile.motion_range <= RIGID_RANGE)) return tile;
  const float2 motion = settled(0.5f * (most + least));
  const int from = source_tile(params, corner, motion);
  const LayerTile before = in->previous[from];
  const bool was_near = before.is_split && near_depth / count > before.between;
  const float2 source_phase = was_near ? (float2)(before.phase_x, before.phase_y)
                                       : (float2)(previous_tiles[from].phase_x, previous_tiles[from].phase_y);
  const float2 phase = phase_after(source_phase, motion);
  tile.phase_x = phase.x;
  tile.phase_y = phase.y;
  tile.is_rigid = 1;
  return tile;
}

// The layers of a tile whose far layer is `tile`, which may change. `hidden`: what the samples show is a near layer
// in history.
static inline LayerTile layer_tile(const TemporalTileParams* params, DEPTH_TEXELS depth, const LayerInputs* in,
                                   SampleRange samples, ReprojectionRange found, int2 at, float2 corner,
                                   __global const TileReprojection* previous_tiles, TileReprojection* tile,
                                   bool* hidden) {
  LayerTile layers = {0.0f, 0.0f, 0.0f, 0.0f, 0, 0, 0};
  if (is_marked(params, in->marks, at.x, at.y))
    layers = near_layer_of(params, in, widened(params, samples), corner, previous_tiles);
  const float2 scale = (float2)(params->motion_x, params->motion_y);
  const float reach = (float)kFetchReach;
  const bool from_split = was_split(params, in->previous, corner + found.least.xy * scale - reach,
                                    corner + (float)kTemporalTile + found.most.xy * scale + reach);
  layers.is_layered = layers.is_split || from_split;
  if (layers.is_split) tile->has_motion_edge = 1;
  *hidden = from_split && (!tile->is_rigid || take_near_phase(params, depth, in, samples, corner, tile));
  return layers;
}
