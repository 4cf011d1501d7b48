// SPDX-License-Identifier: MIT
// Motion edges: where the velocities of neighbouring samples differ. History there mixes both surfaces.
#pragma once

#include "error_bound.h"

namespace quincunx::reference {

// Output pixels a frame: a difference of velocity from which a motion edge counts, and from which it counts
// fully. docs/temporal.md, section reproject.
constexpr double kRejectedEdgeMin = .15;
constexpr double kRejectedEdgeMax = .6;

// 0 below `low`, 1 above `high`, 3 t^2 - 2 t^3 between.
template <typename Real>
Real smooth_step(const Real& x, double low, double high) {
  const Real t = clamp((x - low) * (1 / (high - low)), 0, 1);
  return t * t * (3 - 2 * t);
}

// In [0, 1], of a difference of velocity.
template <typename Real>
Real motion_edge_strength(const Real& motion_edge) {
  return smooth_step(motion_edge, kRejectedEdgeMin, kRejectedEdgeMax);
}

}  // namespace quincunx::reference
