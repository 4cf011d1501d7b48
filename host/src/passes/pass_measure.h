// SPDX-License-Identifier: MIT
// Conclusions from the sums that check_motion and measure_content write. Pure.
#pragma once

#include <array>
#include <cstddef>

#include "picture_params.h"
#include "quincunx/advanced/content_statistics.h"
#include "quincunx/advanced/extent.h"
#include "quincunx/advanced/motion_check.h"

namespace quincunx {

// Judges velocity by the sums of several frames.
class MotionWatch {
 public:
  // Takes the sums of a frame; an axis along which little moves says nothing.
  void add(const MotionSums& frame);

  // Returns what the frames so far say.
  MotionCheck check() const;

 private:
  // The sign of an axis by the last frames that say something of it, all of which must agree.
  class Axis {
   public:
    void add(unsigned samples, double as_said, double turned);

    // Returns by how many dB it is better as said; negative: turned. 0: not known.
    double margin_db() const { return margin_db_; }

   private:
    static constexpr std::size_t kFrames = 8;

    struct Errors {
      double as_said = 0, turned = 0;
      double margin_db() const;
    };

    std::array<Errors, kFrames> frames_ = {};
    std::size_t count_ = 0;
    double margin_db_ = 0;
  };

  Axis x_, y_;
};

// Returns the tiles that measure_content counts a picture of this size by.
Extent content_tiles(Extent output);

// Returns the shares that follow from measure_content's counts.
ContentStatistics statistics_of(const ContentSums& sums, Extent output);

}  // namespace quincunx
