// SPDX-License-Identifier: MIT
// IEEE 754 half precision and 8-bit sRGB (IEC 61966-2-1), by their definitions.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace quincunx::reference {

inline double half_value(std::uint16_t bits) {
  const double sign = (bits & 0x8000) != 0 ? -1 : 1;
  const int exponent = (bits >> 10) & 31;
  const int fraction = bits & 1023;
  if (exponent == 31) {
    return fraction != 0 ? std::numeric_limits<double>::quiet_NaN()
                         : sign * std::numeric_limits<double>::infinity();
  }
  if (exponent == 0) return sign * std::ldexp(fraction, -24);
  return sign * std::ldexp(1024 + fraction, exponent - 25);
}

// To nearest, ties to even.
inline std::uint16_t half_bits(double value) {
  const std::uint16_t sign = std::signbit(value) ? 0x8000 : 0;
  const double magnitude = std::abs(value);
  if (std::isnan(value)) return 0x7e00;
  if (magnitude >= 65520) return static_cast<std::uint16_t>(sign | 0x7c00);
  int exponent = magnitude < 0x1p-14 ? -14 : std::ilogb(magnitude);
  const double steps = std::nearbyint(std::ldexp(magnitude, 10 - exponent));
  // A carry into the next exponent is right as it is: the fraction overflows into it.
  const int biased = magnitude < 0x1p-14 ? 0 : exponent + 14;
  return static_cast<std::uint16_t>(sign | ((biased << 10) + static_cast<int>(steps)));
}

// Linear light of an encoded value in [0, 1].
inline double linear_of_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

// The encoded value of linear light in [0, 1].
inline double srgb_of_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace quincunx::reference
