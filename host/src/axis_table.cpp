// SPDX-License-Identifier: MIT
#include "axis_table.h"

#include <algorithm>
#include <cmath>

namespace quincunx {
namespace {

// The weight of the right tap, a multiple of 2^-24: then both it and 1 - it are floats, and their sum is
// exactly 1.
float exact_weight(double weight) {
  constexpr double kSteps = 16777216;
  return static_cast<float>(std::nearbyint(weight * kSteps) / kSteps);
}

AxisTap tap_at(double u, int render) {
  const int last = render - 1;
  const double floor = std::floor(u);
  AxisTap tap{};
  tap.nearest = std::clamp(static_cast<int>(std::ceil(u - .5)), 0, last);
  // Beyond either end both taps clamp to the same texel, which then takes the whole weight.
  double right = u - floor;
  int base = static_cast<int>(floor);
  if (base < 0) {
    base = 0;
    right = 0;
  } else if (base >= last) {
    base = std::max(last - 1, 0);
    right = last > 0 ? 1 : 0;
  }
  tap.base = base;
  tap.weight1 = exact_weight(right);
  tap.weight0 = 1 - tap.weight1;
  return tap;
}

}  // namespace

void fill_axis(int render, int output, double jitter, AxisTap* taps) {
  for (int x = 0; x < output; ++x) {
    // (2x + 1) * render is an integer: one rounding, and none at all where the quotient is a double.
    const double centre = (2.0 * x + 1) * render / (2.0 * output);
    taps[x] = tap_at(centre - .5 - jitter, render);
  }
}

AxisTables::AxisTables(const Device::Impl& device, Extent output)
    : output_(output), ring_(device, count() * sizeof(AxisTap)) {}

const cl::Buffer& AxisTables::get(const cl::CommandQueue& queue, Extent render, Vec2 jitter) {
  return ring_.get(queue, render, jitter, [&](std::byte* bytes) {
    auto* taps = reinterpret_cast<AxisTap*>(bytes);
    fill_axis(render.width, output_.width, jitter.x, taps);
    std::fill(taps + output_.width, taps + row_axis(), taps[output_.width - 1]);
    fill_axis(render.height, output_.height, jitter.y, taps + row_axis());
    return count() * sizeof(AxisTap);
  });
}

}  // namespace quincunx
