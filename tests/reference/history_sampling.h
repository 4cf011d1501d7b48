// SPDX-License-Identifier: MIT
// Reading history between its texels, for resolve_temporal and temporal_display.
#pragma once

#include "temporal.h"

namespace quincunx::reference {

// Keys' a of the history: -1 scores .04 dB above -.75 (docs/lab/temporal.md).
constexpr double kHistorySharpness = -1;

// Returns the weights of the four texels around a place, `f` past the second.
template <typename Real>
std::array<Real, 4> cubic_weights(const Real& f, double a) {
  const Real rest = 1 - f;
  const Real w0 = a * f * rest * rest;
  const Real w1 = ((a + 2) * f - (a + 3)) * f * f + 1;
  const Real w3 = a * rest * f * f;
  return {w0, w1, 1 - w0 - w1 - w3, w3};
}

// 0 on a texel, 1 midway.
template <typename Real>
Real between_texels(const std::array<Real, 2>& fraction) {
  return min(4 * (fraction[0] * (1 - fraction[0]) + fraction[1] * (1 - fraction[1])), 1);
}

// History where a pixel's picture was in the previous frame.
template <typename Real>
struct FetchedHistory {
  HistoryTexel<Real> known = {};
  std::array<int, 2> texel = {};  // the nearest one, which may lie outside
  Real between = 0;               // how far between texels it was read: 0 at a texel's centre, 1 midway
};

// History of output pixel (x, y), whose tile is `tile` and whose nearest sample has `reprojection`.
template <typename Real>
FetchedHistory<Real> fetch_history(const TemporalInputs& in, const TileReprojection& tile,
                                   const Reprojection& reprojection, const TemporalOptions& options, int x,
                                   int y);

// History at texel (x, y) + fraction, fraction within [0, 1], by the cubic of Keys, "Cubic Convolution
// Interpolation for Digital Image Processing", 1981, with his parameter `a`; clamped to the range of the
// middle four of its 16 texels. Texels are clamped to the edge.
template <typename Real>
PixelOf<Real> sample_cubic(const TemporalInputs& in, int x, int y, const std::array<Real, 2>& fraction,
                           double a);

// The same of its alpha.
template <typename Real>
Real sample_alpha_cubic(const TemporalInputs& in, int x, int y, const std::array<Real, 2>& fraction,
                        double a);

}  // namespace quincunx::reference
