// SPDX-License-Identifier: MIT
// How bright samples are, what that takes of their weight, and which are outliers.
#pragma once

#include <algorithm>

#include "../temporal.h"

namespace quincunx::reference {

template <typename Real>
Real brightest(const PixelOf<Real>& c) {
  return max(max(c[0], c[1]), max(c[2], 0));
}

// A sample's weight times its luma weight 1 / max(1, brightest / 2): one sample shall not outshine the others.
template <typename Real>
Real luma_weighted(const Real& weight, const PixelOf<Real>& sample) {
  return weight / max(1, .5 * brightest(sample));
}

// Outliers are five times as bright as history and more, or as negative as it is bright. Several side by side may be
// faults of one frame.
constexpr double kOutlierRatioMin = 5;
constexpr double kOutlierFloor = .25;         // light: between two dark values every ratio may occur
constexpr double kNegativeOutlierFloor = .1;  // light: colours of a wider gamut are that negative

// Returns whether a valid sample is one for a texel of history.
template <typename Real>
bool is_outlier(const Pixel& sample, const PixelOf<Real>& history) {
  const Real light = max(max(abs(history[0]), abs(history[1])), abs(history[2]));
  return std::max({sample[0], sample[1], sample[2]}) > kOutlierRatioMin * (light + kOutlierFloor) ||
         std::min({sample[0], sample[1], sample[2]}) < -(light + kNegativeOutlierFloor);
}

}  // namespace quincunx::reference
