// SPDX-License-Identifier: MIT
// OutputFollower: an output resolution that follows the render resolution ("dual" resolution scaling).
//
// If few samples are drawn, upscaling them to the whole display is wasted. So the passes from upscaling on may run at a
// smaller output, whose picture is then scaled to the display. Each change of the output resamples the history, so the
// output moves in few, large steps, each only when the render resolution has clearly moved on, and then rests. Pure
// values; not thread safe. Source: "Dynamic Resolution Scaling Implementation Best Practice", section 10.
#pragma once

#include "quincunx/advanced/export.h"
#include "quincunx/advanced/extent.h"
#include "quincunx/control/resolution_ladder.h"
#include "quincunx/status.h"

namespace quincunx {

struct OutputSettings {
  Extent display = {};       // the largest output; both sides in [1, 32768]
  double min_scale = 0.5;    // smallest output as a fraction of the display, per axis; in (0, 1]
  int steps = 8;             // at most so many for each axis, of equal size; at least 1
  double max_filled = 0.64;  // see dual_output()
  double hysteresis = 0.15;  // fraction of the render area that is lost before the output falls; in [0, 1)
  int rest_frames = 30;      // at least, between two changes, until a viewport has more pixels; at least 0
};

class QUINCUNX_API OutputFollower {
 public:
  // Creates a follower. Errors: kInvalidArgument for a field outside its range.
  static Result<OutputFollower> create(const OutputSettings& settings);

  // Follows one frame, of the extent that it is drawn at; the first one at once. An empty extent changes nothing.
  // Returns output().
  Extent observe(Extent render);

  Extent output() const { return output_; }          // the display's before the first frame
  Extent min_output() const { return outputs_[0]; }  // the smallest there may be

 private:
  OutputFollower(const OutputSettings& settings, ResolutionLadder outputs);

  OutputSettings settings_;
  ResolutionLadder outputs_;
  Extent output_;
  int since_;
};

}  // namespace quincunx
