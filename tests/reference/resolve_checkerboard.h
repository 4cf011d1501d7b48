// SPDX-License-Identifier: MIT
// resolve_checkerboard: the specification. error_bound.h tells what `Real` may be.
#pragma once

#include <vector>

#include "error_bound.h"
#include "passes.h"
#include "picture.h"

namespace quincunx::reference {

struct CheckerboardInputs {
  Frame current;  // pixels (x, y) with (x + y) % 2 != parity hold anything; depth in any case
  int parity = 0;
  Frame previous;  // filled: colour and depth
  bool has_history = true;
  bool reactive = false;  // reactive values of the current frame take trust
  bool moves = false;     // the current frame's velocity counts
  // Where the camera alone moves: the velocity of the nearest and of the farthest surface around each pixel that is not
  // shaded, in uv, with error bounds; else empty.
  std::vector<std::array<Bounded, 2>> nearest_motion = {}, farthest_motion = {};
};

template <typename Real>
struct FilledPixel {
  PixelOf<Real> colour = {};
  int x = 0, y = 0;  // the shaded neighbour whose depth, velocity and reactive value it gets
  Real near_trust = 0, far_trust = 0;
};

// Returns the filled pixel (x, y), which is not shaded.
template <typename Real>
FilledPixel<Real> resolve_checkerboard(const CheckerboardInputs& in, int x, int y);

// Sets the motion that the current frame's clip_to_previous_clip gives the surfaces. `error`: of a velocity, over its
// condition.
void move_camera(CheckerboardInputs& in, double error);

}  // namespace quincunx::reference
