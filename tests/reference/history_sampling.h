// SPDX-License-Identifier: MIT
// Where history is read, in double precision.
#pragma once

#include "temporal.h"

namespace quincunx::reference {

// History where the pixel's picture was, and how far between texels that is.
struct Taken {
  BoundedPixel value;
  Bounded between;
};

Taken take_history(const TemporalInputs& in, const Tile& tile, const Move& move, int x, int y,
                   const TemporalOptions& options, bool& undecided);

// The cubic (Keys 1981) at `fraction` past the second of four texels on either axis, held in the range of the
// middle four; beyond the edges the outermost texel once more. (x, y): the first of the middle four.
BoundedPixel sample_cubic(const TemporalInputs& in, int x, int y, const Bounded& fraction_x,
                          const Bounded& fraction_y, double a);

}  // namespace quincunx::reference
