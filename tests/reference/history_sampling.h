// SPDX-License-Identifier: MIT
// Reading history between its texels, for resolve_temporal and temporal_display.
#pragma once

#include "temporal.h"

namespace quincunx::reference {

// History where a pixel's picture was in the previous frame.
template <typename Real>
struct FetchedHistory {
  HistoryTexel<Real> known = {};
  Real between = 0;  // how far between texels it was read: 0 at a texel's centre, 1 midway
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
