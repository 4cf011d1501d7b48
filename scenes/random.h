// SPDX-License-Identifier: MIT
// Random: seeded randomness that is the same on every platform (the distributions of <random> are not).
#pragma once

#include <cstdint>

namespace quincunx::scenes {

// SplitMix64 (Steele, Lea, Flood: "Fast splittable pseudorandom number generators", 2014). A value; streams
// of the same seed are independent of each other, so that one part of a scene may draw more numbers without
// changing another.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0)
      : state_(mix(seed + 0x9e3779b97f4a7c15u) ^ mix(stream * 0xd1342543de82ef95u + 1)) {}

  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15u;
    return mix(state_);
  }
  float unit() { return static_cast<float>(next() >> 40) * 0x1p-24f; }  // [0, 1)
  float range(float low, float high) { return low + (high - low) * unit(); }
  float signed_unit() { return 2 * unit() - 1; }  // [-1, 1)
  int below(int count) { return static_cast<int>(next() % static_cast<std::uint64_t>(count)); }

  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

 private:
  std::uint64_t state_;
};

}  // namespace quincunx::scenes
