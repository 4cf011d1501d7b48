// SPDX-License-Identifier: MIT
#include "front_curve.h"

#include <algorithm>
#include <cmath>

namespace quincunx {

std::optional<double> value_at(std::span<const FrontPoint> curve, double scale, double FrontPoint::*field) {
  if (curve.empty() || !(scale > 0)) return std::nullopt;
  if (scale <= curve.front().scale) return curve.front().*field;
  if (scale >= curve.back().scale) return curve.back().*field;
  const auto above = std::upper_bound(curve.begin(), curve.end(), scale,
                                      [](double at, const FrontPoint& point) { return at < point.scale; });
  const FrontPoint& low = *(above - 1);
  return std::lerp(low.*field, (*above).*field, (scale - low.scale) / (above->scale - low.scale));
}

}  // namespace quincunx
