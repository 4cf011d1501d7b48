// SPDX-License-Identifier: MIT
#include "level_tracker.h"

#include <algorithm>
#include <cmath>

namespace quincunx {
namespace {

constexpr double kOutlierSigmas = 4;
constexpr double kLeastOutlier = 0.06;
constexpr double kSigmaRate = 0.04;
constexpr double kTrendRate = 0.07;
constexpr double kSlowestRate = 0.03;
constexpr double kRatePower = 3.5;  // of |trend| / magnitude, which is about .2 on noise and 1 on a trend
constexpr double kBiasRate = 0.02;
constexpr double kSigmaPerMagnitude = 1.25;  // of a normal distribution

}  // namespace

void LevelTracker::restart(double level) {
  level_ = level;
  trend_ = 0;
  outliers_ = 0;
  suspect_ = 0;
}

void LevelTracker::follow_outlier(double residual, double level) {
  const int direction = residual > 0 ? 1 : -1;
  if (outliers_ == direction) {
    bias_ = 0;
    excess_[(count_ - 1) % kRemembered] = 0;
    excess_[(count_ - 2) % kRemembered] = 0;
    return restart(std::max(level, suspect_));
  }
  outliers_ = direction;
  suspect_ = level;
  bias_ += kBiasRate * (std::clamp(residual, -0.5, 1.0) - bias_);
}

void LevelTracker::observe(double work, double time) {
  const double level = time / work;
  if (level_ <= 0) return restart(level);
  const double residual = level / level_ - 1;
  excess_[count_++ % kRemembered] = time - level_ * work;
  if (std::abs(residual) > std::max(kOutlierSigmas * sigma_, kLeastOutlier)) {
    follow_outlier(residual, level);
    return;
  }
  outliers_ = 0;
  suspect_ = 0;
  bias_ -= kBiasRate * bias_;
  trend_ += kTrendRate * (residual - trend_);
  magnitude_ += kTrendRate * (std::abs(residual) - magnitude_);
  const double tracking = magnitude_ > 0 ? std::min(1.0, std::abs(trend_) / magnitude_) : 0;
  level_ *= 1 + std::max(kSlowestRate, std::pow(tracking, kRatePower)) * residual;
  sigma_ += kSigmaRate * (kSigmaPerMagnitude * std::abs(residual) - sigma_);
}

double LevelTracker::recurring_excess() const {
  double first = 0;
  double second = 0;
  for (const double excess : excess_) {
    second = std::max(second, std::min(first, excess));
    first = std::max(first, excess);
  }
  return second;
}

}  // namespace quincunx
