// SPDX-License-Identifier: MIT
// temporal_display: one output pixel of the picture that a history holds.
//   m      history at p - R: the cubic of Keys, a = -.75, p being the pixel's centre and R its tile's phase
//   where W < 1.5, W without its sign, which tells of a second layer: (m (W + .02) + sum n e) / (W + .02 + 8 e) with
//          the eight neighbours n, e = .3 exp(-2 W). In place of a neighbour of the other kind, one layer or two, it
//          takes the pixel's own texel: one holds a blade, the other the sky behind it
//   alpha  that of history in the same way, or 1
// Source: found by measuring (docs/lab/temporal.md): smoothing what little is known of is worth .1 dB.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "history_sampling.h"

namespace quincunx::reference {
namespace {

constexpr double kDisplaySharpness = -.75;        // Keys' a
constexpr double kSmoothedConfidenceMax = 1.5;    // confidence; above it smoothing would not be seen
constexpr double kSmoothingOwnWeight = .02;       // weight of the pixel, besides its confidence
constexpr double kSmoothingNeighbourWeight = .3;  // weight of each neighbour where nothing is known
constexpr double kSmoothingFalloff = 2;  // fall of the neighbours' weight, for each unit of confidence

// History at the pixel's centre.
template <typename Real>
HistoryTexel<Real> picture_at(const TemporalInputs& in, const TileReprojection& tile, int x, int y) {
  if (tile.phase[0] == 0 && tile.phase[1] == 0)
    return {as<Real>(in.history_clamped(x, y)), in.alpha_clamped(x, y)};
  std::array<int, 2> texel = {x, y};
  std::array<Real, 2> fraction;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const int back = tile.phase[axis] > 0 ? 1 : 0;
    texel[axis] -= back;
    fraction[axis] = back - Real(tile.phase[axis]);
  }
  HistoryTexel<Real> shown;
  shown.texel = sample_cubic(in, texel[0], texel[1], fraction, kDisplaySharpness);
  if (!in.history_alpha.empty())
    shown.alpha = sample_alpha_cubic(in, texel[0], texel[1], fraction, kDisplaySharpness);
  return shown;
}

// `at(x, y)`: what is smoothed, of a texel.
template <typename Real, typename At>
Real smoothed(const At& at, int x, int y, const Real& centre, const Real& confidence) {
  const Real neighbour = kSmoothingNeighbourWeight * bell(kSmoothingFalloff * confidence);
  const Real own = confidence + kSmoothingOwnWeight;
  Real sum = centre * own;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (dx != 0 || dy != 0) sum += neighbour * at(x + dx, y + dy);
    }
  }
  return sum / (own + 8 * neighbour);
}

template <typename Real>
void smooth(const TemporalInputs& in, int x, int y, HistoryTexel<Real>& shown) {
  const double own = in.history_clamped(x, y)[3];
  const Real confidence = std::abs(own);
  const auto is_own_kind = [&](int i, int j) {
    return std::signbit(in.history_clamped(i, j)[3]) == std::signbit(own);
  };
  for (std::size_t c = 0; c < 3; ++c) {
    const auto channel = [&](int i, int j) {
      return is_own_kind(i, j) ? in.history_clamped(i, j)[c] : in.history_clamped(x, y)[c];
    };
    shown.texel[c] = smoothed(channel, x, y, shown.texel[c], confidence);
  }
  if (in.history_alpha.empty()) return;
  const auto alpha = [&](int i, int j) {
    return is_own_kind(i, j) ? in.alpha_clamped(i, j) : in.alpha_clamped(x, y);
  };
  shown.alpha = smoothed(alpha, x, y, shown.alpha, confidence);
}

}  // namespace

template <typename Real>
PixelOf<Real> temporal_display(const TemporalInputs& in, const std::vector<Tile>& tiles,
                               const DisplayOptions& options, int x, int y) {
  const TileReprojection& tile = tiles[index_of(in.tiles_x(), x / kTile, y / kTile)].reprojection;
  HistoryTexel<Real> shown = picture_at<Real>(in, tile, x, y);
  const double confidence = std::abs(in.history_clamped(x, y)[3]);
  if (options.smooth && confidence < kSmoothedConfidenceMax) smooth(in, x, y, shown);
  return {shown.texel[0], shown.texel[1], shown.texel[2], shown.alpha};
}

template PixelOf<double> temporal_display(const TemporalInputs&, const std::vector<Tile>&,
                                          const DisplayOptions&, int, int);
template PixelOf<Bounded> temporal_display(const TemporalInputs&, const std::vector<Tile>&,
                                           const DisplayOptions&, int, int);

}  // namespace quincunx::reference
