// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "quincunx/frame.h"

namespace quincunx {
namespace {

constexpr std::int64_t kMaxPhases = 512;

bool is_empty(Extent extent) {
  return extent.width < 1 || extent.height < 1;
}

// Halton's radical inverse of `index` in `base`, in (0, 1) for index >= 1.
double radical_inverse(std::uint64_t index, unsigned base) {
  double result = 0;
  double digit_weight = 1.0 / base;
  for (; index > 0; index /= base, digit_weight /= base)
    result += static_cast<double>(index % base) * digit_weight;
  return result;
}

}  // namespace

int jitter_phases(Extent render, Extent output) {
  if (is_empty(render) || is_empty(output)) return 1;
  return static_cast<int>(std::min((8 * output.area() + render.area() - 1) / render.area(), kMaxPhases));
}

Vec2 jitter(std::uint64_t frame_index, Extent render, Extent output) {
  if (is_empty(render) || is_empty(output)) return {};
  const auto phases = static_cast<std::uint64_t>(jitter_phases(render, output));
  const auto place = [&](unsigned base) {
    double mean = 0;
    for (std::uint64_t i = 1; i <= phases; ++i)
      mean += radical_inverse(i, base) / static_cast<double>(phases);
    return static_cast<float>(radical_inverse(frame_index % phases + 1, base) - mean);
  };
  return {place(2), place(3)};
}

float texture_lod_bias(Extent render, Extent output) {
  if (is_empty(render) || is_empty(output)) return 0;
  const double scale = static_cast<double>(render.area()) / static_cast<double>(output.area());
  return static_cast<float>(.5 * std::log2(scale) - 1);
}

}  // namespace quincunx
