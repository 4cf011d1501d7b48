// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdlib>

namespace quincunx::testing {

// How many cases each fuzz test makes; QUINCUNX_FUZZ_ROUNDS=n makes it n.
inline int rounds() {
  constexpr int kRounds = 3000;  // a few seconds each, under the sanitizers too
  const char* value = std::getenv("QUINCUNX_FUZZ_ROUNDS");
  return value != nullptr ? std::max(1, std::atoi(value)) : kRounds;
}

}  // namespace quincunx::testing
