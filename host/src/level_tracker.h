// SPDX-License-Identifier: MIT
// LevelTracker: the level of a load (see cost_model.h), its noise, and what stands out from it.
//
// Within the noise the level follows an average whose rate grows while the residuals keep one sign (after
// Trigg and Leach, "Exponential smoothing with an adaptive response rate", 1967): slow on noise, fast on a
// trend. One residual beyond the noise is an outlier, which the level ignores; a second one in a row on the
// same side is a step.
#pragma once

#include <array>
#include <cstddef>

namespace quincunx {

class LevelTracker {
 public:
  // `work` is what the frame's area counts for, so that time / work is its level.
  void observe(double work, double time);

  double level() const { return level_; }
  // With what outliers, which the level leaves out, add on average.
  double mean_level() const { return level_ * (1 + bias_); }
  double sigma() const { return sigma_; }  // relative
  double trend() const { return trend_; }  // smoothed relative residual: above 0 while the load grows
  // Where the last frame was an outlier: the level if it was a step; else 0.
  double suspect() const { return suspect_; }
  // Second largest time above expectation among the last frames: what has to be expected again.
  double recurring_excess() const;

 private:
  static constexpr std::size_t kRemembered = 120;

  void follow_outlier(double residual, double level);
  void restart(double level);

  double level_ = 0;
  double sigma_ = 0.01;
  double bias_ = 0;
  double trend_ = 0;
  double magnitude_ = 0;  // smoothed absolute residual
  double suspect_ = 0;
  int outliers_ = 0;  // the last frame was one: 1 upwards, -1 downwards
  std::array<double, kRemembered> excess_ = {};
  std::size_t count_ = 0;
};

}  // namespace quincunx
