// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <utility>

#include "opencl.h"

namespace quincunx {

// The host's clock on a queue that has nothing to do at each look. May throw cl::Error.
class QueueStopwatch {
 public:
  explicit QueueStopwatch(const cl::CommandQueue* queue) : queue_(queue) {
    lap_ms();
  }  // null: nothing is timed

  // Waits for the queue. Since the last lap; -1 where nothing is timed.
  double lap_ms() {
    if (queue_ == nullptr) return -1;
    queue_->finish();
    const auto before = std::exchange(last_, std::chrono::steady_clock::now());
    return std::chrono::duration<double, std::milli>(last_ - before).count();
  }

 private:
  const cl::CommandQueue* queue_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace quincunx
