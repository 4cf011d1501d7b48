// SPDX-License-Identifier: MIT
// Random numbers of pixels.
#pragma once

#include <cstdint>

namespace quincunx::reference {

// One step of a permuted congruential generator, "RXS M XS" with 32 bits: O'Neill, "PCG: A Family of Simple
// Fast Space-Efficient Statistically Good Algorithms for Random Number Generation", 2014.
inline std::uint32_t pcg(std::uint32_t value) {
  const std::uint32_t state = value * 747796405u + 2891336453u;
  const std::uint32_t shift = state / 0x10000000u + 4;
  const std::uint32_t word = (state / (std::uint32_t{1} << shift) ^ state) * 277803737u;
  return word / 0x400000u ^ word;
}

// Returns random bits for pixel (x, y): Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020.
inline std::uint32_t random_of(int x, int y, std::uint32_t seed) {
  const std::uint32_t row = pcg(static_cast<std::uint32_t>(y) + pcg(seed));
  return pcg(row + static_cast<std::uint32_t>(x));
}

}  // namespace quincunx::reference
