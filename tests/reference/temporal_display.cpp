// SPDX-License-Identifier: MIT
// temporal_display: one output pixel of the picture that a history holds.
//   m      history at p - R: the cubic of Keys, a = -.75, p being the pixel's centre and R its tile's phase
//   where W < 1.5: (m (W + .02) + sum n e) / (W + .02 + 8 e) with the eight neighbours n, e = .3 exp(-2 W)
//   alpha  this frame's, bilinear, or 1
// Source: found by measuring (docs/temporal.md): smoothing what little is known of is worth .1 dB.
#include <algorithm>
#include <cstddef>

#include "history_sampling.h"

namespace quincunx::reference {
namespace {

constexpr double kDisplaySharpness = -.75;  // Keys' a
constexpr double kSmoothedBelow = 1.5;      // confidence; above it smoothing would not be seen
constexpr double kCentreWeight = .02;       // of the pixel, besides its confidence
constexpr double kNeighbourWeight = .3;     // of each neighbour where nothing is known
constexpr double kFalloff = 2;              // of the neighbours' weight, for each unit of confidence

// History at the pixel's centre.
template <typename Real>
PixelOf<Real> picture_at(const TemporalInputs& in, const TileReprojection& tile, int x, int y) {
  if (tile.phase[0] == 0 && tile.phase[1] == 0) return as<Real>(in.history_clamped(x, y));
  std::array<int, 2> texel = {x, y};
  std::array<Real, 2> fraction;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const int back = tile.phase[axis] > 0 ? 1 : 0;
    texel[axis] -= back;
    fraction[axis] = back - Real(tile.phase[axis]);
  }
  return sample_cubic(in, texel[0], texel[1], fraction, kDisplaySharpness);
}

template <typename Real>
PixelOf<Real> smooth(const TemporalInputs& in, int x, int y, const PixelOf<Real>& centre) {
  const Real confidence = in.history_clamped(x, y)[3];
  const Real neighbour = kNeighbourWeight * bell(kFalloff * confidence);
  const Real own = confidence + kCentreWeight;
  PixelOf<Real> smoothed = {};
  for (std::size_t c = 0; c < 3; ++c) {
    Real sum = centre[c] * own;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (dx != 0 || dy != 0) sum += neighbour * in.history_clamped(x + dx, y + dy)[c];
      }
    }
    smoothed[c] = sum / (own + 8 * neighbour);
  }
  return smoothed;
}

template <typename Real>
Real alpha_at(const TemporalInputs& in, int x, int y) {
  const Frame& frame = in.frame;
  const Between column =
      between_samples(texel_coordinate(x, in.output_width, frame.width, frame.jitter_x), frame.width);
  const Between row =
      between_samples(texel_coordinate(y, in.output_height, frame.height, frame.jitter_y), frame.height);
  const auto on_row = [&](int i) {
    const Real left = sanitised(texel_at(frame, column.left, i)[3]);
    const Real right = sanitised(texel_at(frame, column.right, i)[3]);
    return left + (right - left) * column.fraction;
  };
  const Real upper = on_row(row.left);
  return upper + (on_row(row.right) - upper) * row.fraction;
}

}  // namespace

template <typename Real>
PixelOf<Real> temporal_display(const TemporalInputs& in, const std::vector<Tile>& tiles,
                               const DisplayOptions& options, int x, int y) {
  const TileReprojection& tile = tiles[index_of(in.tiles_x(), x / kTile, y / kTile)].reprojection;
  PixelOf<Real> shown = picture_at<Real>(in, tile, x, y);
  if (options.smooth && in.history_clamped(x, y)[3] < kSmoothedBelow) shown = smooth(in, x, y, shown);
  shown[3] = options.alpha ? alpha_at<Real>(in, x, y) : Real(1);
  return shown;
}

template PixelOf<double> temporal_display(const TemporalInputs&, const std::vector<Tile>&,
                                          const DisplayOptions&, int, int);
template PixelOf<Bounded> temporal_display(const TemporalInputs&, const std::vector<Tile>&,
                                           const DisplayOptions&, int, int);

}  // namespace quincunx::reference
