// SPDX-License-Identifier: MIT
// MotionWatch: what check_motion's sums over several frames say of velocity. Pure.
#pragma once

#include <array>
#include <cstddef>

#include "picture_params.h"
#include "quincunx/advanced/motion_check.h"

namespace quincunx {

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

}  // namespace quincunx
