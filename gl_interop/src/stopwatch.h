// SPDX-License-Identifier: MIT
// Stopwatch: host time since it was made.
#pragma once

#include <chrono>

namespace quincunx::gl {

class Stopwatch {
 public:
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace quincunx::gl
