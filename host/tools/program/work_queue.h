// SPDX-License-Identifier: MIT
// Work on threads of its own, so that files do not hold up the next frame: WorkQueue does jobs, compressing say;
// ReadAhead reads the items of a list, in order, a few ahead of who takes them. OpenImageIO's ImageCache keeps tiles of
// files, not whole frames that are decoded as a method wants them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "quincunx/status.h"
#include "tools/program/clock.h"

namespace quincunx::tools {

// Runs a job of another thread, from which no exception may come: it becomes an error.
Status run_job(const std::function<Status()>& job);

// Adds up to `count` threads that run `work`, fewer where the system has no room for more. Throws std::system_error
// where it has none for one.
void add_threads(std::vector<std::thread>& threads, int count, const std::function<void()>& work);

// Calls work(i), which may not throw, for every index below `count`, from so many threads, the caller's among them.
void for_each_index(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

// Jobs start in the order in which they came; with one thread each also ends before the next starts. The pixels that a
// job holds and writes live in memory from push() to its end, so `depth` bounds that memory.
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

// There are `depth` items in memory and no more, whatever the length of the list; each is read into again and
// again, so it may keep its memory. take() and release() belong to one thread, the reading threads to the
// object.
template <typename Item>
class ReadAhead {
 public:
  // Calls read(index, item) for every index in [0, count), from `threads` threads.
  ReadAhead(std::size_t count, int threads, int depth, std::function<Status(std::size_t, Item&)> read)
      : count_(count), read_(std::move(read)), slots_(static_cast<std::size_t>(depth)) {
    add_threads(threads_, threads, [this] { run(); });
  }

  ~ReadAhead() {
    {
      const std::lock_guard lock(mutex_);
      count_ = 0;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_)
      thread.join();
  }

  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  // Waits for the next item; it belongs to the caller until release(). Errors: what read() said of it; it
  // must then be released all the same. At most `count` times.
  Result<Item*> take() {
    std::unique_lock lock(mutex_);
    Slot& slot = slots_[released_ % slots_.size()];
    changed_.wait(lock, [&] { return slot.ready; });
    if (!slot.status.ok()) return slot.status;
    return &slot.item;
  }

  void release() {
    {
      const std::lock_guard lock(mutex_);
      slots_[released_ % slots_.size()].ready = false;
      ++released_;
    }
    changed_.notify_all();
  }

  double busy_seconds() const {  // spent in read() so far, summed over the threads
    const std::lock_guard lock(mutex_);
    return busy_seconds_;
  }

 private:
  struct Slot {
    Item item;
    Status status;
    bool ready = false;
  };

  void run() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return next_ >= count_ || next_ < released_ + slots_.size(); });
      if (next_ >= count_) return;
      const std::size_t index = next_++;
      Slot& slot = slots_[index % slots_.size()];
      lock.unlock();
      const auto start = std::chrono::steady_clock::now();
      Status status = run_job([&] { return read_(index, slot.item); });
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
      lock.lock();
      busy_seconds_ += took.count();
      slot.status = std::move(status);
      slot.ready = true;
      changed_.notify_all();
    }
  }

  std::size_t count_;
  std::function<Status(std::size_t, Item&)> read_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Slot> slots_;
  std::size_t next_ = 0;      // to be read
  std::size_t released_ = 0;  // taken and given back
  double busy_seconds_ = 0;
  std::vector<std::thread> threads_;
};

}  // namespace quincunx::tools
