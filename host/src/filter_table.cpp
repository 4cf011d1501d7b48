// SPDX-License-Identifier: MIT
#include "filter_table.h"

#include <algorithm>
#include <cmath>

#include "axis_table.h"

namespace quincunx {
namespace {

double widening(int render, int output) {
  return std::max(1.0, static_cast<double>(render) / output);
}

struct Axis {
  const Filter& filter;
  int render;
  int taps;
  int inner;
  double widening;
};

// `u`: the texel coordinate of the pixel's centre, so that texel i is |i - u| away.
void fill_pixel(const Axis& axis, double u, FilterSpan& span, float* weights) {
  constexpr double kLeastWeight = 0x1p-25;
  const int last = axis.render - 1;
  const int left = static_cast<int>(std::floor(u));
  const int ideal = left - axis.taps / 2 + 1;
  // What one clamped texel collects from beyond the edge lands inside of the span as well.
  span.base = std::clamp(ideal, 0, std::max(0, axis.render - axis.taps));
  span.inner = std::clamp(left - axis.inner / 2 + 1, 0, std::max(0, axis.render - axis.inner));

  double sum = 0;
  for (int k = 0; k < axis.taps; ++k)
    sum += axis.filter.weight(std::abs(ideal + k - u) / axis.widening);
  std::fill_n(weights, axis.taps, 0.0f);
  // The taps of one texel follow one another, so each weight is rounded once.
  for (int k = 0; k < axis.taps;) {
    const int texel = std::clamp(ideal + k, 0, last);
    double weight = 0;
    for (; k < axis.taps && std::clamp(ideal + k, 0, last) == texel; ++k)
      weight += axis.filter.weight(std::abs(ideal + k - u) / axis.widening) / sum;
    weights[texel - span.base] = std::abs(weight) < kLeastWeight ? 0 : static_cast<float>(weight);
  }
}

}  // namespace

const Filter* own_filter(Method method) {
  const Filter& filter = methods()[static_cast<std::size_t>(method)].filter;
  return filter.radius > 1 ? &filter : nullptr;
}

bool skips_samples(Method method) {
  return method == Method::kPoint || method == Method::kNoise || method == Method::kNoiseOffset;
}

const Filter& filter_of(Method method) {
  const Filter* own = own_filter(method);
  return own != nullptr ? *own : methods()[static_cast<std::size_t>(Method::kBilinear)].filter;
}

int filter_taps(const Filter& filter, int render, int output) {
  return 2 * static_cast<int>(std::ceil(filter.radius * widening(render, output)));
}

int filter_inner(int render, int output) {
  return 2 * static_cast<int>(std::ceil(widening(render, output)));
}

void fill_filter(const Filter& filter, int render, int output, double jitter, FilterSpan* spans,
                 float* weights) {
  const Axis axis{filter, render, filter_taps(filter, render, output), filter_inner(render, output),
                  widening(render, output)};
  for (int x = 0; x < output; ++x) {
    // (2x + 1) * render is an integer: one rounding, and none at all where the quotient is a double.
    const double centre = (2.0 * x + 1) * render / (2.0 * output);
    fill_pixel(axis, centre - .5 - jitter, spans[x], weights + static_cast<std::ptrdiff_t>(x) * axis.taps);
  }
}

namespace {

// In spans, weights counted with those of the columns that only pad a block.
std::size_t spans_of(Extent output) {
  return static_cast<std::size_t>(padded_columns(output)) + static_cast<std::size_t>(output.height);
}

// Of an axis whose `pixels` have a table each.
std::size_t weights_of(const Filter& filter, int render, int output, int pixels) {
  return static_cast<std::size_t>(pixels) * static_cast<std::size_t>(filter_taps(filter, render, output));
}

std::size_t table_bytes(const Filter& filter, Extent render, Extent output) {
  const std::size_t weights = weights_of(filter, render.width, output.width, padded_columns(output)) +
                              weights_of(filter, render.height, output.height, output.height);
  return spans_of(output) * sizeof(FilterSpan) + weights * sizeof(float);
}

// Of no output within the limits is the table larger. A smaller output has fewer pixels with more taps each.
std::size_t most_bytes(const Filter& filter, const TableLimits& limits) {
  std::size_t across = 0, down = 0;
  for (int width = limits.least_output.width; width <= limits.output.width; ++width)
    across = std::max(across, weights_of(filter, limits.target.width, width, padded_columns({width, 1})));
  for (int height = limits.least_output.height; height <= limits.output.height; ++height)
    down = std::max(down, weights_of(filter, limits.target.height, height, height));
  return spans_of(limits.output) * sizeof(FilterSpan) + (across + down) * sizeof(float);
}

}  // namespace

FilterTables::FilterTables(const Device::Impl& device, const Filter& filter, const TableLimits& limits)
    : filter_(filter), ring_(device, most_bytes(filter, limits)) {}

const cl::Buffer& FilterTables::get(const cl::CommandQueue& queue, const TableKey& key) {
  return ring_.get(queue, key, [&](std::byte* bytes) {
    const Extent output = key.output;
    const Extent render = key.render;
    auto* columns = reinterpret_cast<FilterSpan*>(bytes);
    FilterSpan* rows = columns + padded_columns(output);
    auto* column_weights = reinterpret_cast<float*>(columns + spans_of(output));
    float* row_weights =
        column_weights + weights_of(filter_, render.width, output.width, padded_columns(output));
    fill_filter(filter_, render.width, output.width, key.jitter.x, columns, column_weights);
    std::fill(columns + output.width, rows, columns[output.width - 1]);
    fill_filter(filter_, render.height, output.height, key.jitter.y, rows, row_weights);
    return table_bytes(filter_, render, output);
  });
}

}  // namespace quincunx
