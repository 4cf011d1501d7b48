// SPDX-License-Identifier: MIT
// resize_tiles: makes the tiles of an output of another size from those of the history. resize_history has ended
// phases, so no tile is rigid. A tile has motion edges or layers if any tile of the history under it has.
// Light is that of the tile under its centre.
//
//   params              in   extents
//   previous_tiles      in   TileReprojection of each tile of the history
//   previous_light      in   TileLight
//   previous_layers     in   LAYERS 1: LayerTile
//   tiles               out  TileReprojection of each of the output's tiles
//   light               out  TileLight
//   layers              out  LAYERS 1: LayerTile
// Options: LAYERS  0 (default) | 1
// Reference: tests/reference/resize_history.cpp
#include "layers/layer.h"
#include "temporal/temporal_params.h"

#ifndef LAYERS
#define LAYERS 0
#endif
#if LAYERS < 0 || LAYERS > 1
#error "LAYERS must be 0 or 1"
#endif

// On one axis: the history's tiles under one of the output's, and that under its centre. Exact: products of two sides
// fit into a long.
typedef struct TilesUnder {
  int first, last, middle;
} TilesUnder;

static inline int tile_of(long place, long of, int previous) {
  return (int)min(place / of, (long)(previous - 1)) / kTemporalTile;
}

static inline TilesUnder tiles_under(int tile, int size, int previous) {
  const long start = (long)tile * kTemporalTile, end = min(start + kTemporalTile, (long)size);
  const TilesUnder under = {tile_of(start * previous, size, previous), tile_of(end * previous - 1, size, previous),
                            tile_of((start + end) * previous, 2 * (long)size, previous)};
  return under;
}

__kernel void resize_tiles(const ResizeParams params, __global const TileReprojection* previous_tiles,
                           __global const TileLight* previous_light, __global const LayerTile* previous_layers,
                           __global TileReprojection* tiles, __global TileLight* light, __global LayerTile* layers) {
  const int x = get_global_id(0), y = get_global_id(1);
  if (x >= params.tiles_x || y >= params.tiles_y) return;

  const TilesUnder columns = tiles_under(x, params.width, params.previous_width);
  const TilesUnder rows = tiles_under(y, params.height, params.previous_height);
  TileReprojection tile = {0.0f, 0.0f, 0.0f, 0.0f, 0, 0, 0, 0, 0};
#if LAYERS
  LayerTile layer = {0.0f, 0.0f, 0.0f, 0.0f, 0, 0, 0};
#endif
  for (int row = rows.first; row <= rows.last; ++row) {
    for (int column = columns.first; column <= columns.last; ++column) {
      const int i = row * params.previous_tiles_x + column;
      tile.has_motion_edge |= previous_tiles[i].has_motion_edge;
#if LAYERS
      const LayerTile before = previous_layers[i];
      if (before.is_split && !layer.is_split) layer.between = before.between;
      layer.is_split |= before.is_split;
      layer.is_layered |= before.is_layered;
#endif
    }
  }
  const int i = y * params.tiles_x + x;
  tiles[i] = tile;
  light[i] = previous_light[rows.middle * params.previous_tiles_x + columns.middle];
#if LAYERS
  layers[i] = layer;
#endif
}
