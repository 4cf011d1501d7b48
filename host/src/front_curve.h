// SPDX-License-Identifier: MIT
// The points of one class and method as a function of the scale. Pure.
#pragma once

#include <optional>
#include <span>

#include "quincunx/error_front.h"

namespace quincunx {

// Linear between the points, which ascend in scale, and that of the nearest beyond them. Nothing where there is no
// point, or where the scale is not above 0.
std::optional<double> value_at(std::span<const FrontPoint> curve, double scale, double FrontPoint::*field);

}  // namespace quincunx
