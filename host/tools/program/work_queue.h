// SPDX-License-Identifier: MIT
// WorkQueue: does jobs on threads of its own, so that compressing files, say, does not hold up the next
// frame.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "quincunx/status.h"

namespace quincunx::tools {

// Jobs start in the order in which they came; with one thread each also ends before the next starts. What a
// job holds (the pixels it writes) lives in memory from push() to its end, so `depth` bounds that memory.
class WorkQueue {
 public:
  explicit WorkQueue(int threads = 1, int depth = 3);  // depth: jobs that may wait; both at least 1
  ~WorkQueue();                                        // finishes what was pushed
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  // Hands a job over; waits while `depth` jobs are pending. Returns the first error of an earlier job; the
  // new one is then dropped. One thread at a time.
  Status push(std::function<Status()> job);

  Status finish();  // waits for every job; the first error of any

  double busy_seconds() const;  // spent in jobs so far, summed over the threads

 private:
  void run();

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<Status()>> jobs_;
  std::size_t depth_;
  int busy_ = 0;
  double busy_seconds_ = 0;
  bool stop_ = false;
  Status first_error_;
  std::vector<std::thread> threads_;
};

}  // namespace quincunx::tools
