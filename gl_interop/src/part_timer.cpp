// SPDX-License-Identifier: MIT
#include "quincunx_gl/part_timer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "fence.h"
#include "quincunx_gl/handle.h"

namespace quincunx::gl {
namespace {

constexpr double kLeastPartMs = 1e-6;  // a part without work may come back as 0, which no controller takes

double stamp_ms(GLuint query) {
  GLuint64 nanoseconds = 0;
  glGetQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
  return static_cast<double>(nanoseconds) * 1e-6;
}

// A name becomes a query when it is first used, so it may be one of any kind.
TimeQuery stamp_query() {
  GLuint name = 0;
  glGenQueries(1, &name);
  return TimeQuery::adopt(name);
}

}  // namespace

struct PartTimer::Impl {
  struct Slot {
    TimedFrame part;
    TimeQuery begun, done;
  };

  TimerMethod method = TimerMethod::kFence;
  int every = 1;
  std::uint64_t parts = 0;  // begun so far, timed or not
  std::array<Slot, kRing> slots;
  std::size_t first = 0;  // the oldest under way
  std::size_t count = 0;
  bool open = false;
  std::optional<Stopwatch> watch;

  Slot& next() { return slots[(first + count) % slots.size()]; }
};

PartTimer::PartTimer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PartTimer::~PartTimer() = default;
PartTimer::PartTimer(PartTimer&&) noexcept = default;
PartTimer& PartTimer::operator=(PartTimer&&) noexcept = default;

Result<PartTimer> PartTimer::create(TimerMethod method, int every) {
  if (every < 1) return Status::invalid(fmt::format("every is {}; it must be at least 1", every));
  auto impl = std::make_unique<Impl>();
  impl->method = method;
  impl->every = method == TimerMethod::kFence ? every : 1;
  for (Impl::Slot& slot : impl->slots) {
    if (method != TimerMethod::kQuery) break;
    slot.begun = stamp_query();
    slot.done = stamp_query();
    if (!slot.begun || !slot.done) return Status::device("OpenGL made no query for a time stamp");
  }
  return PartTimer(std::move(impl));
}

void PartTimer::begin(std::uint64_t frame, Extent extent) {
  const bool timed = impl_->parts++ % static_cast<std::uint64_t>(impl_->every) == 0;
  if (!timed || impl_->open || impl_->count == impl_->slots.size()) return;
  Impl::Slot& slot = impl_->next();
  slot.part = {.frame = frame, .render_extent = extent, .gpu_ms = 0};
  impl_->open = true;
  if (impl_->method == TimerMethod::kQuery) {
    glQueryCounter(slot.begun.get(), GL_TIMESTAMP);
    return;
  }
  glFinish();
  impl_->watch.emplace();
}

void PartTimer::end() {
  if (!impl_->open) return;
  Impl::Slot& slot = impl_->next();
  if (impl_->method == TimerMethod::kQuery) {
    glQueryCounter(slot.done.get(), GL_TIMESTAMP);
  } else {
    glFinish();
    slot.part.gpu_ms = impl_->watch->milliseconds();
  }
  impl_->open = false;
  ++impl_->count;
}

std::optional<TimedFrame> PartTimer::poll() {
  if (impl_->count == 0) return std::nullopt;
  Impl::Slot& slot = impl_->slots[impl_->first];
  if (impl_->method == TimerMethod::kQuery) {
    GLuint available = GL_FALSE;
    glGetQueryObjectuiv(slot.done.get(), GL_QUERY_RESULT_AVAILABLE, &available);
    if (available == GL_FALSE) return std::nullopt;
    slot.part.gpu_ms = stamp_ms(slot.done.get()) - stamp_ms(slot.begun.get());
  }
  impl_->first = (impl_->first + 1) % impl_->slots.size();
  --impl_->count;
  TimedFrame result = slot.part;
  result.gpu_ms = std::max(result.gpu_ms, kLeastPartMs);
  return result;
}

}  // namespace quincunx::gl
