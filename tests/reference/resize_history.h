// SPDX-License-Identifier: MIT
// A history in the size of another output: the specification of resize_history, resize_layers and resize_tiles.
// error_bound.h tells what `Real` may be.
#pragma once

#include <array>

#include "layer_history.h"

namespace quincunx::reference {

struct OutputSize {
  int width = 0;
  int height = 0;

  int tiles_x() const { return (width + kTile - 1) / kTile; }
  int tiles_y() const { return (height + kTile - 1) / kTile; }
};

// resize_history: pixel (x, y) of the output. Of `history` only what a frame leaves to the next counts.
template <typename Real>
HistoryTexel<Real> resize_history(const TemporalInputs& history, const OutputSize& output, int x, int y);

// A pixel of a layered tile of the output.
template <typename Real>
struct ResizedLayersOf {
  std::array<Real, 4> state = {};  // as StoredState
  PixelOf<Real> near = {};         // where there are two layers
  bool is_split = false;
};

// resize_layers: pixel (x, y), of a layered tile.
template <typename Real>
ResizedLayersOf<Real> resize_layers(const LayerHistory& history, const OutputSize& output, int x, int y);

// resize_tiles: a tile of the output.
struct ResizedTile {
  Tile tile = {};
  LayerTile layers = {};
};
ResizedTile resize_tile(const LayerHistory& history, const OutputSize& output, int tile_x, int tile_y);

}  // namespace quincunx::reference
