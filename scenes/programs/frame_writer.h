// SPDX-License-Identifier: MIT
// FrameWriter: writes pictures on a thread of its own, so that compressing files does not hold up the next
// frame.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "quincunx/status.h"

namespace quincunx::scenes {

class FrameWriter {
 public:
  FrameWriter();
  ~FrameWriter();  // finishes what was pushed
  FrameWriter(const FrameWriter&) = delete;
  FrameWriter& operator=(const FrameWriter&) = delete;

  // Hands a job over; waits while kDepth jobs are pending. The job owns the pixels it writes. Returns the
  // first error of an earlier job; the new one is then dropped.
  Status push(std::function<Status()> job);

  Status finish();  // waits for every job; the first error of any

 private:
  static constexpr std::size_t kDepth = 3;

  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<Status()>> jobs_;
  bool busy_ = false;
  bool stop_ = false;
  Status first_error_;
  std::thread thread_;
};

}  // namespace quincunx::scenes
