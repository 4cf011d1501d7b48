// SPDX-License-Identifier: MIT
#include "scale.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>

namespace quincunx::reference {
namespace {

// At the distance d >= 0 from the centre; each is 0 from `radius` on.
double filter_value(Filter filter, double d) {
  const double pi = std::numbers::pi;
  switch (filter) {
    case Filter::kTent:
      return d < 1 ? 1 - d : 0;
    case Filter::kBSpline:
      if (d < 1) return 2.0 / 3 - d * d + d * d * d / 2;
      return d < 2 ? (2 - d) * (2 - d) * (2 - d) / 6 : 0;
    case Filter::kCatmullRom:
      if (d < 1) return 1 - 2.5 * d * d + 1.5 * d * d * d;
      return d < 2 ? 2 - 4 * d + 2.5 * d * d - 0.5 * d * d * d : 0;
    case Filter::kLanczos2:
      if (d == 0) return 1;
      return d < 2 ? 2 * std::sin(pi * d) * std::sin(pi * d / 2) / (pi * pi * d * d) : 0;
  }
  return 0;
}

std::vector<AxisFilter> filter_axes(Filter filter, int output, int render, double jitter) {
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

Picture scale(int output_width, int output_height, const Sampler& sampler) {
  Picture picture;
  picture.width = output_width;
  picture.height = output_height;
  for (int y = 0; y < output_height; ++y) {
    for (int x = 0; x < output_width; ++x) {
      const Sample sample = sampler(x, y);
      picture.pixels.push_back(sample.value);
      picture.largest.push_back(sample.largest);
      picture.non_finite += sample.non_finite ? 1 : 0;
    }
  }
  return picture;
}

Sampler point_sampler(const Frame& frame, int output_width, int output_height) {
  return [&frame, output_width, output_height](int x, int y) {
    return sample_nearest(frame, x, y, output_width, output_height);
  };
}

Sampler bilinear_sampler(const Frame& frame, int output_width, int output_height) {
  return [&frame, output_width, output_height](int x, int y) {
    return sample_bilinear(frame, x, y, output_width, output_height);
  };
}

AxisFilter filter_axis(Filter filter, int x, int output, int render, double jitter) {
  const double widening = std::max(1.0, static_cast<double>(render) / output);
  const double u = (x + 0.5) * render / output - 0.5 - jitter;
  const int last = render - 1;
  const int reach = static_cast<int>(std::ceil(2 * widening)) + 1;
  const int centre = static_cast<int>(std::floor(u));
  std::map<int, double> weights;
  double sum = 0;
  for (int i = centre - reach; i <= centre + reach; ++i) {
    const double weight = filter_value(filter, std::abs(i - u) / widening);
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

Sampler filter_sampler(const Frame& frame, Filter filter, bool clamp, int output_width, int output_height) {
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
