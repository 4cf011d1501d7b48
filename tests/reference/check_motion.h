// SPDX-License-Identifier: MIT
// check_motion: how well the previous frame foretells this one by velocity, and by velocity with turned signs: the
// specification. error_bound.h tells what `Real` may be.
#pragma once

#include <array>

#include "error_bound.h"
#include "picture.h"

namespace quincunx::reference {

// Samples that move along an axis.
template <typename Real>
struct MotionErrors {
  int samples = 0;
  // Sums over them, with velocity as it is, with x turned, with y turned, with both.
  std::array<Real, 4> errors = {0, 0, 0, 0};
};

// x and y, of one cell of 4 x 4 samples that are asked, which lie 8 apart.
template <typename Real>
std::array<MotionErrors<Real>, 2> check_motion(const Frame& frame, const Frame& previous, int cell_x,
                                               int cell_y);

}  // namespace quincunx::reference
