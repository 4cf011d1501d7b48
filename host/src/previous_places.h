// SPDX-License-Identifier: MIT
// PreviousPlaces: from samples of a frame to the texel coordinates in the previous one, for passes that follow motion.
#pragma once

#include "quincunx/frame.h"

namespace quincunx {

// The texel coordinate (0 at the first sample, 1 at the next) in the previous frame of sample (i, j), if it stands
// still: (i * step_x + start_x, j * step_y + start_y).
struct PreviousPlaces {
  float step_x, step_y, start_x, start_y;
  float motion_x, motion_y;  // from the units of velocity to pixels of the previous frame, backwards in time
  float edge_x, edge_y;      // the left and the upper edge of the previous frame, as texel coordinates
};

// Pure.
PreviousPlaces previous_places(const FrameInputs& current, const FrameInputs& previous);

}  // namespace quincunx
