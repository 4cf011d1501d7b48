// SPDX-License-Identifier: MIT
// temporal_refine: the specification. In tone space, t = c / (1 + max(red, green, blue, 0)), for each channel
//   t' = clamp(t + a (t - m) + K (b D_t + c D_n), l, h)
//   a, b, c   .05 + .35 / (W + .6), .03 + .5 / (W + .15), 0 of a pixel of one layer and confidence W;
//             0, .2, -.12 of one of two layers, whose confidence is negative
//   m, l, h   mean and range of the 3x3 pixels around
//   D_n, D_t  second derivatives across and along the edge; K its coherence, 0 to 1: both of the sums of luma's
//             gradients' products over the 3x3 pixels, (1 2 1) by (1 2 1) / 16
// and back, within +-65504. Alpha stays. NaN counts as 0, what is beyond +-65504 as that. Neighbours are clamped to the
// edge.
// Source: Bigun and Granlund, "Optimal Orientation Detection of Linear Symmetry", 1987.
#pragma once

#include <vector>

#include "error_bound.h"
#include "picture.h"

namespace quincunx::reference {

// `confidences`: of each pixel, as history stores them.
template <typename Real>
PixelOf<Real> temporal_refine(const Picture& picture, const std::vector<double>& confidences, int x, int y);

}  // namespace quincunx::reference
