// SPDX-License-Identifier: MIT
#include "tools/program/jitter.h"

#include <algorithm>
#include <cmath>

namespace quincunx::tools {
namespace {

// Halton's radical inverse of `index` in `base`, in (0, 1) for index >= 1.
double radical_inverse(std::int64_t index, int base) {
  double result = 0;
  double digit_weight = 1.0 / base;
  for (; index > 0; index /= base, digit_weight /= base) {
    result += static_cast<double>(index % base) * digit_weight;
  }
  return result;
}

Vec2 halton(std::int64_t index, Vec2 ratio) {
  const double scale = static_cast<double>(ratio.x) * ratio.y;
  const auto phases = static_cast<std::int64_t>(std::ceil(8 / std::max(scale, 1.0 / 64)));
  double mean_x = 0;
  double mean_y = 0;
  for (std::int64_t i = 1; i <= phases; ++i) {
    mean_x += radical_inverse(i, 2) / static_cast<double>(phases);
    mean_y += radical_inverse(i, 3) / static_cast<double>(phases);
  }
  const std::int64_t phase = index % phases + 1;
  return {static_cast<float>(radical_inverse(phase, 2) - mean_x),
          static_cast<float>(radical_inverse(phase, 3) - mean_y)};
}

}  // namespace

const char* name_of(Jitter jitter) {
  switch (jitter) {
    case Jitter::kNone:
      return "none";
    case Jitter::kQuincunx:
      return "quincunx";
    case Jitter::kQuincunxHalf:
      return "quincunx-half";
    case Jitter::kHalton:
      return "halton";
  }
  return "unknown";
}

Vec2 jitter_of(Jitter jitter, std::int64_t index, Vec2 ratio) {
  switch (jitter) {
    case Jitter::kNone:
      return {};
    case Jitter::kQuincunx:
      return index % 2 == 0 ? Vec2{-0.25f, -0.25f} : Vec2{0.25f, 0.25f};
    case Jitter::kQuincunxHalf:
      return index % 2 == 0 ? Vec2{} : Vec2{0.5f, 0.5f};
    case Jitter::kHalton:
      return halton(index, ratio);
  }
  return {};
}

}  // namespace quincunx::tools
