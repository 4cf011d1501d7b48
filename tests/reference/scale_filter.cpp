// SPDX-License-Identifier: MIT
// scale_filter: a separable filter. With r = max(1, render / output) on an axis, the sample at the distance d
// from the output pixel's centre, in render pixels, has the weight f(d / r) over the sum of all weights.
//   tent           1 - d                                                                       d < 1
//   b_spline       2/3 - d^2 + d^3 / 2                                                         d < 1
//                  (2 - d)^3 / 6                                                               d < 2
//   catmull_rom    1 - 5/2 d^2 + 3/2 d^3                                                       d < 1
//                  2 - 4 d + 5/2 d^2 - 1/2 d^3                                                 d < 2
//   mitchell       8/9 - 2 d^2 + 7/6 d^3                                                       d < 1
//                  16/9 - 10/3 d + 2 d^2 - 7/18 d^3                                            d < 2
//   lanczos2, 3    sinc(d) sinc(d / n), sinc(x) = sin(pi x) / (pi x)                           d < n
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>

#include "scale.h"

namespace quincunx::reference {
namespace {

double tent(double d) {
  return d < 1 ? 1 - d : 0;
}

double b_spline(double d) {
  if (d < 1) return 2.0 / 3 - d * d + d * d * d / 2;
  return d < 2 ? (2 - d) * (2 - d) * (2 - d) / 6 : 0;
}

double catmull_rom(double d) {
  if (d < 1) return 1 - 2.5 * d * d + 1.5 * d * d * d;
  return d < 2 ? 2 - 4 * d + 2.5 * d * d - 0.5 * d * d * d : 0;
}

double mitchell(double d) {
  if (d < 1) return 8.0 / 9 - 2 * d * d + 7.0 / 6 * d * d * d;
  return d < 2 ? 16.0 / 9 - 10.0 / 3 * d + 2 * d * d - 7.0 / 18 * d * d * d : 0;
}

double windowed_sinc(double d, double lobes) {
  const double pi = std::numbers::pi;
  if (d == 0) return 1;
  return d < lobes ? lobes * std::sin(pi * d) * std::sin(pi * d / lobes) / (pi * pi * d * d) : 0;
}

double lanczos2(double d) {
  return windowed_sinc(d, 2);
}

double lanczos3(double d) {
  return windowed_sinc(d, 3);
}

// A new filter is one row and its formula.
constexpr Filter kFilters[] = {
    {"bilinear", 1, tent, false},
    // Sigg and Hadwiger, "Fast Third-Order Texture Filtering", GPU Gems 2, 2005.
    {"b-spline", 2, b_spline, false},
    // Keys, "Cubic Convolution Interpolation for Digital Image Processing", 1981: a = -1/2.
    {"catmull-rom", 2, catmull_rom, true},
    // Mitchell and Netravali, "Reconstruction Filters in Computer Graphics", 1988: B = C = 1/3.
    {"mitchell", 2, mitchell, true},
    // Duchon, "Lanczos Filtering in One and Two Dimensions", 1979: 2 and 3 lobes.
    {"lanczos2", 2, lanczos2, true},
    {"lanczos3", 3, lanczos3, true},
};

std::vector<AxisFilter> filter_axes(const Filter& filter, int output, int render, double jitter) {
  std::vector<AxisFilter> axes;
  for (int x = 0; x < output; ++x)
    axes.push_back(filter_axis(filter, x, output, render, jitter));
  return axes;
}

void clamp_to_inner(const Frame& frame, const AxisFilter& column, const AxisFilter& row, Pixel& value) {
  for (std::size_t c = 0; c < 4; ++c) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (int j = row.inner_first; j <= row.inner_last; ++j) {
      for (int i = column.inner_first; i <= column.inner_last; ++i) {
        low = std::min(low, sanitised(texel_at(frame, i, j)[c]));
        high = std::max(high, sanitised(texel_at(frame, i, j)[c]));
      }
    }
    value[c] = std::clamp(value[c], low, high);
  }
}

}  // namespace

const Filter& filter_named(std::string_view name) {
  const auto* found = std::find_if(std::begin(kFilters), std::end(kFilters),
                                   [&](const Filter& filter) { return name == filter.name; });
  if (found == std::end(kFilters)) throw std::invalid_argument("no filter " + std::string(name));
  return *found;
}

std::span<const Filter> all_filters() {
  return kFilters;
}

AxisFilter filter_axis(const Filter& filter, int x, int output, int render, double jitter) {
  const double widening = std::max(1.0, static_cast<double>(render) / output);
  const double u = texel_coordinate(x, output, render, jitter);
  const int last = render - 1;
  const int reach = static_cast<int>(std::ceil(filter.support * widening)) + 1;
  const int centre = static_cast<int>(std::floor(u));
  std::map<int, double> weights;
  double sum = 0;
  for (int i = centre - reach; i <= centre + reach; ++i) {
    const double weight = filter.value(std::abs(i - u) / widening);
    weights[std::clamp(i, 0, last)] += weight;
    sum += weight;
  }
  AxisFilter axis;
  for (const auto& [texel, weight] : weights) {
    if (std::abs(weight / sum) >= 0x1p-25) axis.taps.push_back({texel, weight / sum});
  }
  const int half = static_cast<int>(std::ceil(widening));
  const int width = std::min(2 * half, render);
  axis.inner_first = std::clamp(centre - half + 1, 0, render - width);
  axis.inner_last = axis.inner_first + width - 1;
  return axis;
}

Sampler scale_filter(const Frame& frame, const Filter& filter, bool clamp, int output_width,
                     int output_height) {
  return [&frame, clamp, columns = filter_axes(filter, output_width, frame.width, frame.jitter_x),
          rows = filter_axes(filter, output_height, frame.height, frame.jitter_y)](int x, int y) {
    const AxisFilter& column = columns[static_cast<std::size_t>(x)];
    const AxisFilter& row = rows[static_cast<std::size_t>(y)];
    Sample sample;
    for (const Tap& down : row.taps) {
      for (const Tap& across : column.taps)
        add(sample, texel_at(frame, across.texel, down.texel), down.weight * across.weight);
    }
    if (clamp) clamp_to_inner(frame, column, row, sample.value);
    return sample;
  };
}

}  // namespace quincunx::reference
