// SPDX-License-Identifier: MIT
#include "frame_writer.h"

#include <utility>

namespace quincunx::scenes {

FrameWriter::FrameWriter() : thread_([this] { run(); }) {}

FrameWriter::~FrameWriter() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

Status FrameWriter::push(std::function<Status()> job) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return jobs_.size() < kDepth || !first_error_.ok(); });
  if (!first_error_.ok()) return first_error_;
  jobs_.push_back(std::move(job));
  lock.unlock();
  changed_.notify_all();
  return {};
}

Status FrameWriter::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return jobs_.empty() && !busy_; });
  return first_error_;
}

void FrameWriter::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stop_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    const std::function<Status()> job = std::move(jobs_.front());
    jobs_.pop_front();
    busy_ = true;
    lock.unlock();
    Status status = job();
    lock.lock();
    busy_ = false;
    if (first_error_.ok() && !status.ok()) first_error_ = std::move(status);
    changed_.notify_all();
  }
}

}  // namespace quincunx::scenes
