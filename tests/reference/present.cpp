// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "passes.h"

namespace quincunx::reference {
namespace {

// IEC 61966-2-1, 1999.
double srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double tone_mapped(double x, Curve curve) {
  x = std::max(x, 0.0);
  switch (curve) {
    case Curve::kClamp:
      return std::min(x, 1.0);
    case Curve::kReinhard:
      return x / (1 + x);
    case Curve::kAces:
      return std::min(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 1.0);
  }
  return 0;
}

}  // namespace

Pixel present(const Pixel& resolved, Curve curve, double exposure) {
  Pixel codes = {};
  for (std::size_t c = 0; c < 3; ++c)
    codes[c] = 255 * srgb(tone_mapped(sanitised(resolved[c]) * exposure, curve));
  codes[3] = 255 * std::clamp(sanitised(resolved[3]), 0.0, 1.0);
  return codes;
}

double dither_offset(int x, int y) {
  // The fractional part of x / g + y / g^2, where g^3 = g + 1, with 32 bits of each factor: the R2 sequence of
  // Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018.
  const auto phase = static_cast<std::uint32_t>(static_cast<std::uint64_t>(x) * 3242174889u +
                                                static_cast<std::uint64_t>(y) * 2447445414u);
  return static_cast<double>(phase >> 8) / 16777216.0;
}

}  // namespace quincunx::reference
