// SPDX-License-Identifier: MIT
// CostModel: a frame's time is a level (its time at the output resolution) times the work at its area fraction p:
//   work(p) = b + (1 - b) p
// b, the part that does not scale, is learned from pairs of frames of different area.
#pragma once

namespace quincunx {

class CostModel {
 public:
  explicit CostModel(double fixed_part) : fixed_part_(fixed_part), prior_(fixed_part) {}

  double work(double area) const { return fixed_part_ + (1 - fixed_part_) * area; }
  double area_for(double work) const { return (work - fixed_part_) / (1 - fixed_part_); }

  // area_for() if less of the cost scaled than is believed, for moves away from an area that must not fall
  // short. The doubt vanishes as b becomes known.
  double cautious_area_for(double work, double from_area) const;

  // Times of frames in order. Only neighbours whose areas differ enough say something about b.
  void learn(double area, double time);
  // The next frame's time has an error that those before it had not: it is no neighbour of theirs.
  void part_from_frames_before() { last_time_ = 0; }

  double fixed_part() const { return fixed_part_; }

 private:
  double fixed_part_;
  double prior_;
  double weighted_sum_ = 0;
  double weights_ = 0;
  double last_area_ = 0;
  double last_time_ = 0;
};

}  // namespace quincunx
