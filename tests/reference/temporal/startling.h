// SPDX-License-Identifier: MIT
// Startling samples: five times as bright as history and more, or as negative as it is bright. Several side by side may
// be faults of one frame.
#pragma once

#include "../temporal.h"

namespace quincunx::reference {

constexpr double kStartlingMultiple = 5;
constexpr double kStartlingFloor = .25;  // light: between two dark values every ratio may occur
constexpr double kNegativeFloor = .1;    // light: colours of a wider gamut are that negative

// Whether a valid sample is so for a texel of history.
template <typename Real>
bool is_startling(const Pixel& sample, const PixelOf<Real>& history) {
  const Real light = max(max(abs(history[0]), abs(history[1])), abs(history[2]));
  return std::max({sample[0], sample[1], sample[2]}) > kStartlingMultiple * (light + kStartlingFloor) ||
         std::min({sample[0], sample[1], sample[2]}) < -(light + kNegativeFloor);
}

}  // namespace quincunx::reference
