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

namespace {

std::size_t count_of(Extent output) {
  return static_cast<std::size_t>(padded_columns(output)) + static_cast<std::size_t>(output.height);
}

}  // namespace

AxisTables::AxisTables(const Device::Impl& device, Extent most)
    : ring_(device, count_of(most) * sizeof(AxisTap)) {}

const cl::Buffer& AxisTables::get(const cl::CommandQueue& queue, const TableKey& key) {
  return ring_.get(queue, key, [&](std::byte* bytes) {
    const Extent output = key.output;
    auto* columns = reinterpret_cast<AxisTap*>(bytes);
    AxisTap* rows = columns + padded_columns(output);
    fill_axis(key.render.width, output.width, key.jitter.x, columns);
    std::fill(columns + output.width, rows, columns[output.width - 1]);
    fill_axis(key.render.height, output.height, key.jitter.y, rows);
    return count_of(output) * sizeof(AxisTap);
  });
}

}  // namespace quincunx
