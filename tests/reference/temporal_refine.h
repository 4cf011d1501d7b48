// SPDX-License-Identifier: MIT
// temporal_refine: the specification. In tone space, t = c / (1 + max(red, green, blue, 0)), for each channel
//   t' = clamp(t + .03 (t - m) + K (.21 D_t - .03 D_n), l, h)
//   m, l, h   mean and range of the 3x3 pixels around
//   D_n, D_t  second derivatives across and along the edge; K its coherence, 0 to 1: both of the sums of luma's
//             gradients' products over the 3x3 pixels, (1 2 1) by (1 2 1) / 16
// and back, within +-65504. Alpha stays. NaN counts as 0, what is beyond +-65504 as that. Neighbours are clamped to the
// edge.
// Source: Bigun and Granlund, "Optimal Orientation Detection of Linear Symmetry", 1987.
#pragma once

#include "error_bound.h"
#include "picture.h"

namespace quincunx::reference {

template <typename Real>
PixelOf<Real> temporal_refine(const Picture& picture, int x, int y);

}  // namespace quincunx::reference
