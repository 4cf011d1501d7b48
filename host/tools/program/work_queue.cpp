// SPDX-License-Identifier: MIT
#include "tools/program/work_queue.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <utility>

namespace quincunx::tools {

Status run_job(const std::function<Status()>& job) {
  try {
    return job();
  } catch (const std::bad_alloc&) {
    return Status::device("out of memory");  // short enough to need none
  } catch (const std::exception& error) {
    return Status::device(std::string("work on another thread failed: ") + error.what());
  }
}

void add_threads(std::vector<std::thread>& threads, int count, const std::function<void()>& work) {
  threads.reserve(static_cast<std::size_t>(std::max(count, 0)));
  for (int i = 0; i < count; ++i) {
    try {
      threads.emplace_back(work);
    } catch (const std::system_error&) {
      if (threads.empty()) throw;
      return;
    }
  }
}

void for_each_index(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  const auto run = [&] {
    for (std::size_t i; (i = next.fetch_add(1)) < count;)
      work(i);
  };
  std::vector<std::thread> helpers;
  try {
    add_threads(helpers, threads - 1, run);
  } catch (const std::system_error&) {  // then the caller's thread does it alone
  }
  run();
  for (std::thread& helper : helpers)
    helper.join();
}

WorkQueue::WorkQueue(int threads, int depth) : depth_(static_cast<std::size_t>(std::max(depth, 1))) {
  add_threads(threads_, std::max(threads, 1), [this] { run(); });
}

WorkQueue::~WorkQueue() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_)
    thread.join();
}

Status WorkQueue::push(std::function<Status()> job) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return jobs_.size() < depth_ || !first_error_.ok(); });
  if (!first_error_.ok()) return first_error_;
  jobs_.push_back(std::move(job));
  lock.unlock();
  changed_.notify_all();
  return {};
}

Status WorkQueue::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return jobs_.empty() && busy_ == 0; });
  return first_error_;
}

double WorkQueue::busy_seconds() const {
  const std::lock_guard lock(mutex_);
  return busy_seconds_;
}

void WorkQueue::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stop_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    std::function<Status()> job = std::move(jobs_.front());
    jobs_.pop_front();
    ++busy_;
    lock.unlock();
    const Clock::time_point start = Clock::now();
    Status status = run_job(job);
    job = nullptr;  // what it held goes before the next may come
    const std::chrono::duration<double> took = Clock::now() - start;
    lock.lock();
    --busy_;
    busy_seconds_ += took.count();
    if (first_error_.ok() && !status.ok()) first_error_ = std::move(status);
    changed_.notify_all();
  }
}

}  // namespace quincunx::tools
