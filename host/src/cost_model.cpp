// SPDX-License-Identifier: MIT
#include "cost_model.h"

#include <algorithm>
#include <cmath>

namespace quincunx {
namespace {

constexpr double kLargestFixedPart = 0.9;
constexpr double kLeastDifference = 0.03;  // of two areas
constexpr double kDecay = 0.8;             // of older pairs, per pair
constexpr double kPriorWeight = 0.004;     // as much as one pair .063 apart
constexpr double kDoubt = 0.15;            // added to b as long as it is a guess
constexpr double kDoubtFade = 20;          // per weight of pairs: half gone after one pair .19 apart

}  // namespace

double CostModel::cautious_area_for(double wanted, double from_area) const {
  const double doubted = std::min(kLargestFixedPart, fixed_part_ + kDoubt * std::exp(-weights_ * kDoubtFade));
  // The time at from_area was measured, so only the ratio to it is in doubt.
  const double ratio = wanted / work(from_area);
  return (ratio * (doubted + (1 - doubted) * from_area) - doubted) / (1 - doubted);
}

void CostModel::learn(double area, double time) {
  const double difference = area - last_area_;
  if (last_time_ > 0 && std::abs(difference) > kLeastDifference) {
    const double slope = (time - last_time_) / difference;
    const double level = time + slope * (1 - area);
    if (slope > 0 && level > 0) {
      const double weight = difference * difference;
      weighted_sum_ = kDecay * weighted_sum_ + weight * std::clamp(1 - slope / level, 0.0, kLargestFixedPart);
      weights_ = kDecay * weights_ + weight;
      fixed_part_ = (weighted_sum_ + kPriorWeight * prior_) / (weights_ + kPriorWeight);
    }
  }
  last_area_ = area;
  last_time_ = time;
}

}  // namespace quincunx
