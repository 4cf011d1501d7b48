// SPDX-License-Identifier: MIT
// Relighting and rejection: what temporal_light found in the tiles around.
#pragma once

#include <algorithm>
#include <cstddef>

#include "limit_confidence.h"

namespace quincunx::reference {

// On a row linear between the means of two tiles at their common edge, over rows between the tiles' middles.
template <typename Real>
Real between_tiles(const TemporalInputs& in, const std::vector<Tile>& tiles, int x, int y,
                   double TileLight::*what) {
  const auto edge = [&](int column, int row) {
    const auto tile = [&](int i) {
      return Real(tiles[index_of(in.tiles_x(), std::clamp(i, 0, in.tiles_x() - 1), row)].light.*what);
    };
    return .5 * (tile(column - 1) + tile(column));
  };
  const int middle = y - kTile / 2;
  const int above = std::max(middle, 0) / kTile;
  const int below = std::min(above + 1, in.tiles_y() - 1);
  const double down = middle < 0 ? 0 : (middle % kTile + .5) / kTile;
  const double along = (x % kTile + .5) / kTile;
  const auto at_edge = [&](int column) {
    const Real upper = edge(column, above);
    return upper + (edge(column, below) - upper) * down;
  };
  const Real left = at_edge(x / kTile);
  return left + (at_edge(x / kTile + 1) - left) * along;
}

template <typename Real>
void relight(const TemporalInputs& in, const std::vector<Tile>& tiles, int x, int y, PixelOf<Real>& colour) {
  const auto gain = between_tiles<Real>(in, tiles, x, y, &TileLight::gain);
  for (Real& value : colour)
    value *= gain;
}

template <typename Real>
void reject(const TemporalInputs& in, const std::vector<Tile>& tiles, int x, int y, Known<Real>& known) {
  const auto rejection = between_tiles<Real>(in, tiles, x, y, &TileLight::rejection);
  known.rejection = max(known.rejection, rejection);
  known.confidence = min(known.confidence, most_confidence(1 - rejection));
}

}  // namespace quincunx::reference
