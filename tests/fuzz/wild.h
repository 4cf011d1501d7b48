// SPDX-License-Identifier: MIT
// What the fuzz tests share: how much they do, wild numbers, damaged text.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>

#include "quincunx/status.h"
#include "random.h"

namespace quincunx::testing {

using scenes::Random;

// How many cases each fuzz test makes; QUINCUNX_FUZZ_ROUNDS=n makes it n.
inline int rounds() {
  constexpr int kRounds = 3000;  // a few seconds each, under the sanitizers too
  const char* value = std::getenv("QUINCUNX_FUZZ_ROUNDS");
  return value != nullptr ? std::max(1, std::atoi(value)) : kRounds;
}

// Half of them plausible, the others anything that a double or an int can be.
inline double wild(Random& random, double plausible) {
  constexpr double kOdd[] = {0.0,
                             -0.0,
                             -1.0,
                             1e-320,
                             1e-9,
                             1.0,
                             59999.0,
                             60000.0,
                             60000.1,
                             1e18,
                             1e308,
                             std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()};
  switch (random.below(8)) {
    case 0:
      return std::bit_cast<double>(random.next());
    case 1:
      return kOdd[random.below(static_cast<int>(std::size(kOdd)))];
    default:
      return plausible * std::exp2(2 * random.signed_unit());
  }
}

inline int wild_int(Random& random, int plausible, int first = 1) {
  constexpr int kOdd[] = {0, 1, 2, 7, -1, -2, 32768, 32769, 2147483647, -2147483647 - 1};
  return random.below(6) == 0 ? kOdd[random.below(static_cast<int>(std::size(kOdd)))]
                              : first + random.below(plausible);
}

inline std::size_t place_in(const std::string& text, Random& random) {
  return static_cast<std::size_t>(random.below(static_cast<int>(text.size())));
}

inline std::string damaged(std::string text, Random& random) {
  for (int hit = 0, hits = 1 + random.below(4); hit < hits && !text.empty(); ++hit) {
    const int kind = random.below(6);
    char& at = text[place_in(text, random)];
    if (kind == 0) at ^= static_cast<char>(1 << random.below(8));
    if (kind == 1) at = static_cast<char>(random.below(256));
    if (kind == 2) at = random.below(2) == 0 ? '\xff' : '\0';
    if (kind == 3) at = static_cast<char>('0' + random.below(10));
    if (kind == 4) text.insert(place_in(text, random), text, place_in(text, random), 8);
    if (kind == 5 && random.below(8) == 0) text.resize(place_in(text, random));
  }
  return text;
}

// What is wrong, in one sentence.
inline void expect_sentence(std::string_view message) {
  EXPECT_FALSE(message.empty());
  EXPECT_EQ(message.find('\n'), message.npos) << message;
}

inline void expect_sentence(const Status& status) {
  if (!status.ok()) expect_sentence(status.message());
}

}  // namespace quincunx::testing
