// SPDX-License-Identifier: MIT
// PartTimer: how long OpenGL worked on one part of a frame, its shadow map for example, for a controller of that part.
//
// With TimerMethod::kQuery two time stamps, between which other queries may begin and end; nothing waits. With kFence,
// for contexts whose queries cannot be trusted, the host waits before and after the part, which costs the overlap of
// processor and device: so only one part of several is timed. All calls come from the thread where the GL context is
// current.
#pragma once

#include <memory>
#include <optional>

#include "quincunx/advanced/export.h"
#include "quincunx_gl/frame_timer.h"

namespace quincunx::gl {

class QUINCUNX_API PartTimer {
 public:
  static constexpr int kRing = 8;  // parts that may be under way

  // `method`: as FrameTimer::method() of this context says. `every`: with kFence one of so many parts is timed; at
  // least 1. Errors: kInvalidArgument; kDeviceFailure where GL makes no objects.
  static Result<PartTimer> create(TimerMethod method, int every = 1);

  ~PartTimer();
  PartTimer(PartTimer&&) noexcept;
  PartTimer& operator=(PartTimer&&) noexcept;

  // Around the GL calls of the part, at most once a frame. One that is not timed costs nothing and never comes back:
  // with kFence between those that are, else while kRing are under way.
  void begin(std::uint64_t frame, Extent extent);
  void end();

  // The oldest part that has come back, once each; nothing while there is none. `render` is the part's extent. Throws
  // nothing: a lost context looks like parts that never come back.
  std::optional<TimedFrame> poll();

 private:
  struct QUINCUNX_HIDDEN Impl;
  explicit PartTimer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace quincunx::gl
