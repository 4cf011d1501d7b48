// SPDX-License-Identifier: MIT
// QUINCUNX_SKIP(reason): leaves a test out where the machine cannot run it; with QUINCUNX_NO_SKIP=1 (as in
// CI) that is a failure.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string_view>

namespace quincunx::testing {

inline bool skipping_is_forbidden() {
  const char* value = std::getenv("QUINCUNX_NO_SKIP");
  return value != nullptr && std::string_view(value) == "1";
}

}  // namespace quincunx::testing

#define QUINCUNX_SKIP(reason)                                                  \
  do {                                                                         \
    if (quincunx::testing::skipping_is_forbidden()) {                          \
      FAIL() << "a skip is forbidden here (QUINCUNX_NO_SKIP=1): " << (reason); \
    } else {                                                                   \
      GTEST_SKIP() << (reason);                                                \
    }                                                                          \
  } while (false)
