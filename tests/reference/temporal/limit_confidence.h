// SPDX-License-Identifier: MIT
// History of an output pixel: how far it is to be believed, and in which light it is taken.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "../history_sampling.h"
#include "../motion_edge.h"
#include "nearest_sample.h"

namespace quincunx::reference {

// Confidence, in weights of samples: what is ever kept (about 140 frames at scale .5), and once resampled.
constexpr double kConfidenceMax = 32;
constexpr double kResampledConfidenceMax = 8;
// Cost in confidence for each resampling midway between texels; .2 instead of .3 is worth .05 dB.
constexpr double kResamplingCost = .2;
// Part of the way between texels, from which on history counts as resampled.
constexpr double kResampledMin = .01;
// Output pixels of a motion edge that begin to cost confidence, and that cost most; 4 instead of 2 as the cost
// leaves fewer ghosts: pixels above 2/255 on a texture fall from .052 to .033 %.
constexpr double kCostlyEdgeMin = .1;
constexpr double kCostlyEdgeMax = 1;
constexpr double kEdgeCost = 4;

// ---- Trust in history, by what reproject found.

// Returns a sample's trust; there is none without velocity or depth.
inline double known_trust(const Reprojection& sample) {
  return std::isnan(sample.trust) ? 0 : std::max(sample.trust, 0.0);
}

// Where nothing moves only reactive values of both frames take trust.
template <typename Real>
Real trust_of_still(const TemporalInputs& in, int x, int y) {
  if (in.frame.reactive.empty()) return 1;
  const auto before = [](int sample, int size, int size_before) {
    return truncate_within((sample + Real(.5)) * (static_cast<double>(size_before) / size), 0,
                           size_before - 1);
  };
  const int column = before(x, in.frame.width, in.previous_width);
  const int row = before(y, in.frame.height, in.previous_height);
  const Real now = in.frame.reactive[index_of(in.frame.width, x, y)];
  const Real then = in.reactive_before[index_of(in.previous_width, column, row)];
  return (1 - now) * (1 - then);
}

template <typename Real>
Real trust_at(const TemporalInputs& in, const Neighbourhood<Real>& near) {
  if (in.reprojections.empty()) return trust_of_still<Real>(in, near.x.sample, near.y.sample);
  return known_trust(in.reprojection_at(near.x.sample, near.y.sample));
}

// ---- What is known of a pixel.

template <typename Real>
struct Known {
  PixelOf<Real> colour;  // colour of history; the fourth channel is not used
  Real alpha;
  Real confidence;
  Real rejection;    // in [0, 1]
  Real inertia = 0;  // inertia of a seed, against this frame's sample
};

// Returns the most confidence that a trust in [0, 1] leaves: 32 for a whole one, 1 for a half, 0 for none.
template <typename Real>
Real most_confidence(const Real& trust) {
  return trust / (1 + 1 / kConfidenceMax - trust);
}

template <typename Real>
Real limit_confidence(const FetchedHistory<Real>& history, const Real& trust, double motion_edge) {
  Real w = clamp(history.known.texel[3], 0, kConfidenceMax);
  w = w / (1 + kResamplingCost * history.between * w);
  if (history.between > kResampledMin) w = min(w, kResampledConfidenceMax);
  w = min(w, most_confidence(trust));
  const Real edge = smooth_step(Real(motion_edge), kCostlyEdgeMin, kCostlyEdgeMax);
  return w / (1 + kEdgeCost * edge * w);
}

// ---- Relighting and rejection, by the tiles around.

// Interpolates, on a row linear between the means of two tiles at their common edge, over rows between the tiles'
// middles.
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

// Interpolates between the centres of cells.
template <typename Real>
Real rejection_between_cells(const TemporalInputs& in, const std::vector<Tile>& tiles, int x, int y) {
  constexpr int kCell = kTile / 2;
  const auto cell = [&](int column, int row) {
    column = std::clamp(column, 0, 2 * in.tiles_x() - 1);
    row = std::clamp(row, 0, 2 * in.tiles_y() - 1);
    const Tile& tile = tiles[index_of(in.tiles_x(), column / 2, row / 2)];
    return Real(tile.light.cells[static_cast<std::size_t>(2 * (row % 2) + column % 2)].rejection);
  };
  const double across = (x + .5) / kCell - .5, down = (y + .5) / kCell - .5;
  const int column = static_cast<int>(std::floor(across)), row = static_cast<int>(std::floor(down));
  const auto in_column = [&](int i) {
    const Real upper = cell(i, row);
    return upper + (cell(i, row + 1) - upper) * (down - row);
  };
  const Real left = in_column(column);
  return left + (in_column(column + 1) - left) * (across - column);
}

template <typename Real>
void reject(const TemporalInputs& in, const std::vector<Tile>& tiles, int x, int y, Known<Real>& known) {
  const auto rejection = rejection_between_cells<Real>(in, tiles, x, y);
  known.rejection = max(known.rejection, rejection);
  known.confidence = min(known.confidence, most_confidence(1 - rejection));
}

}  // namespace quincunx::reference
