// SPDX-License-Identifier: MIT
#include "position_table.h"

#include <algorithm>
#include <cmath>

#include "resolve_params.h"

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

int position_columns(Extent output) {
  constexpr int kStep = kReprojectedBlock;
  return (output.width + kStep - 1) / kStep * kStep;
}

namespace {

std::size_t count_of(Extent output) {
  return 2 * (static_cast<std::size_t>(position_columns(output)) + static_cast<std::size_t>(output.height));
}

}  // namespace

PositionTables::PositionTables(const Device::Impl& device, Extent most)
    : ring_(device, count_of(most) * sizeof(float)) {}

const cl::Buffer& PositionTables::get(const cl::CommandQueue& queue, const TableKey& key) {
  return ring_.get(queue, key, [&](std::byte* bytes) {
    const Extent output = key.output;
    const int columns = position_columns(output);
    auto* texels = reinterpret_cast<int*>(bytes);
    auto* fractions = reinterpret_cast<float*>(texels + columns);
    fill_positions(key.render.width, output.width, key.jitter.x, texels, fractions);
    std::fill(texels + output.width, texels + columns, texels[output.width - 1]);
    std::fill(fractions + output.width, fractions + columns, fractions[output.width - 1]);
    texels = reinterpret_cast<int*>(fractions + columns);
    fill_positions(key.render.height, output.height, key.jitter.y, texels,
                   reinterpret_cast<float*>(texels + output.height));
    return count_of(output) * sizeof(float);
  });
}

}  // namespace quincunx
