// SPDX-License-Identifier: MIT
// DetailFollower: detail settings that follow the resolution that a controller chooses.
//
// Level of detail, blur samples, shading rate and the like change in a few levels. Each change is visible and may cost
// time. So the level changes only when the resolution has clearly moved on, and then rests. dual_output() does the same
// for the output resolution. Pure values; not thread safe. Source: "Dynamic Resolution Scaling Implementation Best
// Practice", section 10 (scale settings as well as resolution; "dual" resolution scaling).
#pragma once

#include "quincunx/advanced/export.h"
#include "quincunx/advanced/extent.h"
#include "quincunx/control/resolution_ladder.h"
#include "quincunx/status.h"

namespace quincunx {

struct DetailSettings {
  int levels = 4;            // in [2, 64]; 0 is the full detail, levels - 1 the least
  double full_area = 0.8;    // area fraction from which detail is full
  double min_area = 0.3;     // area fraction to which it falls to the least; in (0, full_area)
  double hysteresis = 0.25;  // part of a level that has to be passed before it is left; in [0, 1]
  int rest_frames = 30;      // at least, between two changes; at least 0
};

class QUINCUNX_API DetailFollower {
 public:
  // Creates a follower. Errors: kInvalidArgument for a field outside its range.
  static Result<DetailFollower> create(const DetailSettings& settings = {});

  // Follows one frame, of the area fraction that it is drawn at: at most one level a call, and none for a fraction that
  // is not a positive finite number. Returns level().
  int observe(double area_fraction);
  int level() const { return level_; }
  // Returns the level as a share: 1 full detail, 0 the least. Multiply sample counts or distances by a range of it.
  double share() const { return 1 - static_cast<double>(level_) / (settings_.levels - 1); }

 private:
  explicit DetailFollower(const DetailSettings& settings)
      : settings_(settings), since_(settings.rest_frames) {}

  DetailSettings settings_;
  int level_ = 0;
  int since_;
};

// Returns the output extent for a render extent: the smallest rung of `outputs` whose area the render
// extent fills to at most `max_filled` (in (0, 1]); where all are filled more, the highest rung. With 0.64,
// passes after upscaling run at the lowest output until the render extent reaches .8 of it on each axis, and
// at larger ones from there on. Errors: kInvalidArgument for an empty render extent or a max_filled outside
// its range.
QUINCUNX_API Result<Extent> dual_output(const ResolutionLadder& outputs, Extent render,
                                        double max_filled = 0.64);

}  // namespace quincunx
