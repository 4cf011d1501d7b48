// SPDX-License-Identifier: MIT
// overlay_particles: the specification. error_bound.h tells what `Real` may be.
#pragma once

#include "error_bound.h"
#include "picture.h"

namespace quincunx::reference {

template <typename Real>
struct OverlaidPixel {
  PixelOf<Real> colour = {};
  Real reactive = 0;
  bool has_particles = false;  // else colour and reactive value are the frame's, bit for bit
  bool keeps_colour = false;   // colour is the frame's, which is not finite
};

// Pixel (x, y) of `frame`, which has colour, depth and reactive values, with `particles` laid over it, which have the
// same at a resolution of their own.
template <typename Real>
OverlaidPixel<Real> overlay_particles(const Frame& frame, const Frame& particles, int x, int y);

}  // namespace quincunx::reference
