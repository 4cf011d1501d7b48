// SPDX-License-Identifier: MIT
// ContentStatistics: the kinds of motion and change in a frame, as shares of its picture, and the mix of scene classes
// that follows.
//
// Any source will do: sums that passes make for tiles, a coarse grid of velocities, or the program's knowledge of its
// camera. A share that is not measured is 0. Values; any thread may use its own.
#pragma once

#include "quincunx/advanced/export.h"
#include "quincunx/control/error_front.h"
#include "quincunx/status.h"

namespace quincunx {

// Shares are of the picture's area, in [0, 1]. A place may count for several of them.
struct ContentStatistics {
  double moving = 0;    // that moves by kMovingPx or more
  double speed_px = 0;  // mean speed of that share, output pixels a frame; finite, at least 0
  double apart = 0;     // in which surfaces move apart from each other
  double thin = 0;      // in which things thinner than four pixels move before something else
  double light = 0;     // whose colour changes and has no velocity: reactive values, moving shadows
  double zoom = 0;      // that moves and grows or shrinks
  bool cut = false;     // the first frame of a shot: nothing of the frames before it is of use
  // Whether `light` includes moving light, and not only reactive values. The temporal upscaler detects it when it
  // judges its history.
  bool judged = false;

  static constexpr double kMovingPx = 0.25;  // output pixels a frame
};

// Errors: kInvalidArgument for a field outside its range.
QUINCUNX_API Status check(const ContentStatistics& content);

// Each place once: as light, else thin, else objects, else zoom, else pan, else still. The content has been checked.
QUINCUNX_API SceneMix mix_of(const ContentStatistics& content);

}  // namespace quincunx
