// SPDX-License-Identifier: MIT
// FrameTimer: how long OpenGL worked on each frame, for a resolution controller, without ever waiting for it.
//
// GL_TIME_ELAPSED queries are trusted only if they agree with fences on a known load when the timer is made;
// software renderers count something else. The fall-back sees by a fence that a frame is done. Its time runs
// from begin(), or from when the frame before it was seen done, to the poll() that sees it. So it is an upper
// bound that is as exact as polls are frequent. All calls come from the thread where the GL context is
// current.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "quincunx/advanced/export.h"
#include "quincunx/image.h"
#include "quincunx/status.h"

namespace quincunx::gl {

enum class TimerMethod : std::uint8_t { kQuery, kFence };

struct TimedFrame {
  std::uint64_t frame = 0;
  Extent render_extent = {};
  double gpu_ms = 0;  // above 0
};

class QUINCUNX_API FrameTimer {
 public:
  static constexpr int kRing = 8;  // frames that may be under way

  // Without a method the queries are validated, which draws for some milliseconds, and the fall-back is taken
  // where they fail; the choice is logged once. Errors: kDeviceFailure where GL makes no objects.
  static Result<FrameTimer> create(std::optional<TimerMethod> method = std::nullopt);

  ~FrameTimer();
  FrameTimer(FrameTimer&&) noexcept;
  FrameTimer& operator=(FrameTimer&&) noexcept;

  TimerMethod method() const;

  // Around the GL calls of a frame; never nested. begin() returns false, and the frame stays untimed, while
  // kRing frames are under way; end() then does nothing.
  bool begin(std::uint64_t frame, Extent render);
  void end();

  // The oldest frame that has come back, once each; nothing while there is none. Call until it says nothing. Frames
  // whose time the driver calls worthless stay untimed.
  // Throws nothing: a lost context looks like frames that never come back.
  std::optional<TimedFrame> poll();

 private:
  struct QUINCUNX_HIDDEN Impl;
  explicit FrameTimer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// Measures how long OpenGL worked on one part of a frame, its shadow map for example, for a controller of that part.
//
// With TimerMethod::kQuery it takes two time stamps, between which other queries may begin and end, and nothing waits.
// With kFence the host waits before and after the part, which costs the overlap of processor and device; so only one
// part of several is timed.
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
