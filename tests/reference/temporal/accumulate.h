// SPDX-License-Identifier: MIT
// Accumulation: history moved towards the nearest sample of this frame.
#pragma once

#include <cstddef>

#include "frame_samples.h"
#include "limit_confidence.h"
#include "reseed.h"

namespace quincunx::reference {

// Output pixels from which on a sample has no weight: in rigid tiles, and elsewhere. In still tiles it falls with W.
constexpr double kSampleReach = .98;
constexpr double kWideReach = 1.05;
constexpr double kStillReachMin = .82;
constexpr double kReachNarrowing = .05;  // for each unit of confidence
constexpr double kWeightSumMin = 1e-30;  // against a division by 0

template <typename Real>
Real reach_of(const TileReprojection& tile, const Real& confidence) {
  if (stands_still(tile)) return max(kSampleReach - kReachNarrowing * confidence, kStillReachMin);
  return Real(tile.is_rigid ? kSampleReach : kWideReach);
}

// Returns the weight of a sample `dx` and `dy` output pixels away.
template <typename Real>
Real sample_weight(const PixelOf<Real>& sample, const Real& dx, const Real& dy, const Real& reach) {
  const Real near = max(1 - (dx * dx + dy * dy) / (reach * reach), 0);
  return luma_weighted(near * near, sample);
}

// Whether a tile holds a sample back from history that is known.
template <typename Real>
bool holds_back(const TileLight& tile, const Known<Real>& known, const Pixel& sample) {
  return tile.holds_back && is_valid(sample) && known.confidence >= kConfidenceMin &&
         is_outlier(sample, known.colour);
}

template <typename Real>
HistoryTexel<Real> accumulate(const Known<Real>& known, const PixelOf<Real>& sample, const Real& weight) {
  HistoryTexel<Real> updated = {known.colour, known.alpha};
  const Real total = known.confidence + weight;
  const Real share = weight / max(total + known.inertia, kWeightSumMin);
  for (std::size_t c = 0; c < 3 && is_valid(sample); ++c)
    updated.texel[c] += (sample[c] - updated.texel[c]) * share;
  if (is_valid(sample)) updated.alpha += (sample[3] - updated.alpha) * share;
  updated.texel[3] = min(total, kConfidenceMax);
  return updated;
}

}  // namespace quincunx::reference
