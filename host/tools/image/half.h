// SPDX-License-Identifier: MIT
// Halves in host memory.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace quincunx::tools {

// Returns a half's value; infinity and what is no number become some large number.
inline float from_half(std::uint16_t half) {
  const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(half & 0x7fffu) << 13) * 0x1p112f;
  return (half & 0x8000u) != 0 ? -value : value;
}

// Returns the half nearest to a number that is finite, within ±65504; of two the one that is further from 0.
inline std::uint16_t to_half(float value) {
  const float small = std::clamp(value, -65504.f, 65504.f) * 0x1p-112f;
  const auto bits = std::bit_cast<std::uint32_t>(small);
  return static_cast<std::uint16_t>((((bits & 0x7fffffffu) + 0x1000u) >> 13) | (bits >> 16 & 0x8000u));
}

}  // namespace quincunx::tools
