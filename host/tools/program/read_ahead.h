// SPDX-License-Identifier: MIT
// ReadAhead: reads the items of a list on threads of its own, in order, a few ahead of who takes them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "quincunx/status.h"

namespace quincunx::tools {

// There are `depth` items in memory and no more, whatever the length of the list; each is read into again and
// again, so it may keep its memory. take() and release() belong to one thread, the reading threads to the
// object.
template <typename Item>
class ReadAhead {
 public:
  // Calls read(index, item) for every index in [0, count), from `threads` threads.
  ReadAhead(std::size_t count, int threads, int depth, std::function<Status(std::size_t, Item&)> read)
      : count_(count), read_(std::move(read)), slots_(static_cast<std::size_t>(depth)) {
    for (int i = 0; i < threads; ++i)
      threads_.emplace_back([this] { run(); });
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
    using Clock = std::chrono::steady_clock;
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return next_ >= count_ || next_ < released_ + slots_.size(); });
      if (next_ >= count_) return;
      const std::size_t index = next_++;
      Slot& slot = slots_[index % slots_.size()];
      lock.unlock();
      const Clock::time_point start = Clock::now();
      Status status = read_(index, slot.item);
      const std::chrono::duration<double> took = Clock::now() - start;
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
