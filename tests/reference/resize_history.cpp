// SPDX-License-Identifier: MIT
// resize_history: c: a pixel's centre in texels of the history, R: the phase of the tile of the texel nearest to it.
//   places  on an axis of r texels a pixel: c where r <= 1.5, else n = min(ceil(r), 4) of them, r / n apart about c
//   m       mean over the places p of history at p - R, by the cubic of Keys, a = -1; no place lies further out than
//           the centre of an outermost texel
//   W       min(s |W'|, 8), where the output grows min(s |W'|, 1), with the sign of W', of the texel nearest to c;
//           s: the smaller of 1 and texels a pixel
// resize_layers: the same of the near layer with its own phase, where the texel nearest to c has two layers.
// resize_tiles: a tile has motion edges, layers and splits where a tile of the history under it has, no phase, and the
//   light of the tile under its centre.
// Source: share and limit were found by measuring (docs/lab/options.md).
#include "resize_history.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace quincunx::reference {
namespace {

constexpr double kSinglePlaceRatioMax = 1.5;   // texels a pixel, from which one place would skip some
constexpr int kMostPlaces = 4;                 // on an axis
constexpr double kResampledConfidenceMax = 8;  // most confidence in history that was resampled
constexpr double kGrownConfidenceMax = 1;      // where pixels are more than texels

// One axis of a pixel among the texels.
struct Axis {
  int texels = 0;
  int pixels = 0;
  int pixel = 0;

  double ratio() const { return static_cast<double>(texels) / pixels; }
  int places() const {
    return ratio() <= kSinglePlaceRatioMax ? 1 : std::min(static_cast<int>(std::ceil(ratio())), kMostPlaces);
  }
  // Returns the place of the pixel's centre, 0 at the first texel's.
  double centre() const { return (2.0 * pixel + 1) * texels / (2.0 * pixels) - .5; }
  // Returns the nearest texel, the first of two equally near ones.
  int nearest() const { return std::clamp(static_cast<int>(std::ceil(centre() - .5)), 0, texels - 1); }
  // Returns the pixel's i-th place.
  template <typename Real>
  Split<Real> place(int i, double phase) const {
    const int whole = static_cast<int>(std::floor(centre()));
    const Real way = Real(2 * i + 1 - places()) / (2 * places()) * ratio() - phase;
    Split<Real> at = split(Real(centre() - whole) + way);
    at.whole += whole;
    // Between two texels, or on the outermost one where that is the only one.
    const int last = texels - 1;
    if (at.whole < 0) return {0, 0};
    if (at.whole >= last) return {std::max(last - 1, 0), last > 0 ? 1.0 : 0.0};
    return at;
  }
};

using Axes = std::array<Axis, 2>;

Axes axes_of(int width, int height, const OutputSize& output, int x, int y) {
  return {Axis{width, output.width, x}, Axis{height, output.height, y}};
}

// The mean of sample(texel, fraction) over a pixel's places.
template <typename Real, typename Value, typename Sample>
void mean_over_places(const Axes& axes, const std::array<double, 2>& phase, Value& mean, Sample sample) {
  const int count = axes[0].places() * axes[1].places();
  for (int j = 0; j < axes[1].places(); ++j) {
    for (int i = 0; i < axes[0].places(); ++i) {
      const Split<Real> at_x = axes[0].template place<Real>(i, phase[0]);
      const Split<Real> at_y = axes[1].template place<Real>(j, phase[1]);
      sample(std::array<int, 2>{at_x.whole, at_y.whole}, std::array<Real, 2>{at_x.fraction, at_y.fraction},
             Real(1) / count, mean);
    }
  }
}

// Returns the confidence that is left of a texel's.
template <typename Real>
Real confidence_left(const Axes& axes, const Real& known) {
  const double texels = axes[0].ratio() * axes[1].ratio();  // a pixel
  return min(abs(known) * Real(std::min(texels, 1.0)),
             texels < 1 ? kGrownConfidenceMax : kResampledConfidenceMax);
}

// The history's tiles under one of the output's on an axis.
struct TilesUnder {
  int first = 0, last = 0, middle = 0;

  TilesUnder(int tile, int pixels, int texels) {
    const double start = kTile * tile;
    const double end = std::min(start + kTile, static_cast<double>(pixels));
    const auto tile_at = [&](double pixel) {  // products of integers: exact
      return std::min(static_cast<int>(std::floor(pixel * texels / pixels)), texels - 1) / kTile;
    };
    first = tile_at(start);
    last = (static_cast<int>(std::ceil(end * texels / pixels)) - 1) / kTile;
    middle = tile_at((start + end) / 2);
  }
};

}  // namespace

template <typename Real>
HistoryTexel<Real> resize_history(const TemporalInputs& history, const OutputSize& output, int x, int y) {
  const Axes axes = axes_of(history.output_width, history.output_height, output, x, y);
  const int near_x = axes[0].nearest();
  const int near_y = axes[1].nearest();
  const TileReprojection& tile =
      history.before[index_of(history.tiles_x(), near_x / kTile, near_y / kTile)].reprojection;
  HistoryTexel<Real> resized;
  resized.alpha = history.history_alpha.empty() ? 1 : 0;
  mean_over_places<Real>(
      axes, tile.phase, resized, [&](const auto& texel, const auto& fraction, const Real& part, auto& mean) {
        const auto read = sample_cubic(history, texel[0], texel[1], fraction, kHistorySharpness);
        for (std::size_t c = 0; c < 3; ++c)
          mean.texel[c] += read[c] * part;
        if (history.history_alpha.empty()) return;
        mean.alpha += part * sample_alpha_cubic(history, texel[0], texel[1], fraction, kHistorySharpness);
      });
  const double known = history.history_clamped(near_x, near_y)[3];
  const Real left = confidence_left<Real>(axes, Real(known));
  resized.texel[3] = std::signbit(known) ? -left : left;
  return resized;
}

template <typename Real>
ResizedLayersOf<Real> resize_layers(const LayerHistory& history, const OutputSize& output, int x, int y) {
  const Axes axes = axes_of(history.width, history.height, output, x, y);
  const int near_x = axes[0].nearest();
  const int near_y = axes[1].nearest();
  const auto state = state_at<Real>(history, near_x, near_y);
  ResizedLayersOf<Real> resized;
  resized.state = {sqrt(sqrt(state.far_depth)), sqrt(sqrt(state.near_depth)),
                   confidence_left(axes, state.near_confidence)};
  resized.is_split = history.has_two(near_x, near_y);
  if (!resized.is_split) return resized;
  const auto near = [&](int i, int j) { return near_texel<Real>(history, state.between(), i, j); };
  const std::array<double, 2>& phase = history.layers[history.tile(near_x, near_y)].phase;
  mean_over_places<Real>(axes, phase, resized,
                         [&](const auto& texel, const auto& fraction, const Real& part, auto& mean) {
                           const auto read = blend_taps(history, texel, fraction, kHistorySharpness, near);
                           for (std::size_t c = 0; c < 4; ++c)
                             mean.near[c] += read.value[c] * part;
                           if (!history.alpha.empty()) mean.state[3] += read.alpha * part;
                         });
  return resized;
}

ResizedTile resize_tile(const LayerHistory& history, const OutputSize& output, int tile_x, int tile_y) {
  const TilesUnder columns(tile_x, output.width, history.width);
  const TilesUnder rows(tile_y, output.height, history.height);
  const int tiles_x = (history.width + kTile - 1) / kTile;
  ResizedTile resized;
  for (int row = rows.first; row <= rows.last; ++row) {
    for (int column = columns.first; column <= columns.last; ++column) {
      const std::size_t i = index_of(tiles_x, column, row);
      const LayerTile& before = history.layers[i];
      if (before.is_split && !resized.layers.is_split) resized.layers.between = before.between;
      resized.layers.is_split |= before.is_split;
      resized.layers.is_layered |= before.is_layered;
      resized.tile.reprojection.has_motion_edge |= history.tiles[i].reprojection.has_motion_edge;
    }
  }
  resized.tile.light = history.tiles[index_of(tiles_x, columns.middle, rows.middle)].light;
  return resized;
}

template HistoryTexel<double> resize_history(const TemporalInputs&, const OutputSize&, int, int);
template HistoryTexel<Bounded> resize_history(const TemporalInputs&, const OutputSize&, int, int);
template ResizedLayersOf<double> resize_layers(const LayerHistory&, const OutputSize&, int, int);
template ResizedLayersOf<Bounded> resize_layers(const LayerHistory&, const OutputSize&, int, int);

}  // namespace quincunx::reference
