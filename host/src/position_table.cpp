// SPDX-License-Identifier: MIT
#include "position_table.h"

#include <algorithm>
#include <cmath>

#include "params.h"

namespace quincunx {

static_assert(sizeof(int) == sizeof(float), "a table holds both");

void fill_positions(int render, int output, double jitter, int* texels, float* fractions) {
  for (int x = 0; x < output; ++x) {
    // As in fill_axis: one rounding at most.
    const double centre = (2.0 * x + 1) * render / (2.0 * output);
    const double u = centre - .5 - jitter;
    const double floor = std::floor(u);
    texels[x] = static_cast<int>(floor);
    fractions[x] = static_cast<float>(u - floor);
  }
}

PositionTables::PositionTables(const Device::Impl& device, Extent output)
    : output_(output), ring_(device, count() * sizeof(float)) {}

int PositionTables::columns() const {
  constexpr int kStep = kReprojectedBlock;
  return (output_.width + kStep - 1) / kStep * kStep;
}

std::size_t PositionTables::count() const {
  return 2 * (static_cast<std::size_t>(columns()) + static_cast<std::size_t>(output_.height));
}

const cl::Buffer& PositionTables::get(const cl::CommandQueue& queue, Extent render, Vec2 jitter) {
  return ring_.get(queue, render, jitter, [&](std::byte* bytes) {
    auto* texels = reinterpret_cast<int*>(bytes);
    auto* fractions = reinterpret_cast<float*>(texels + columns());
    fill_positions(render.width, output_.width, jitter.x, texels, fractions);
    std::fill(texels + output_.width, texels + columns(), texels[output_.width - 1]);
    std::fill(fractions + output_.width, fractions + columns(), fractions[output_.width - 1]);
    texels = reinterpret_cast<int*>(fractions + columns());
    fill_positions(render.height, output_.height, jitter.y, texels,
                   reinterpret_cast<float*>(texels + output_.height));
    return count() * sizeof(float);
  });
}

}  // namespace quincunx
