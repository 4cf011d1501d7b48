// SPDX-License-Identifier: MIT
// How bright samples are, and what that takes of their weight.
#pragma once

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

}  // namespace quincunx::reference
