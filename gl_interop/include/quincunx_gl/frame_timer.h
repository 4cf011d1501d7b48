// SPDX-License-Identifier: MIT
// FrameTimer, PartTimer: measure how long OpenGL worked on each frame, or on a part of it, for a resolution controller.
//
// FrameTimer never waits for a frame. It uses GL_TIME_ELAPSED queries only if they agree with fences on a known load
// when the timer is made, as software renderers count something else. Otherwise a fence shows that a frame is done. The
// frame's time then runs from begin(), or from the poll() that saw the previous frame done, to the poll() that sees it
// done: an upper bound that is as exact as polls are frequent. All calls come from the thread where the GL context is
// current, and restore GL's state.
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

  // Creates a timer. Without a method it validates the queries, which draws for some milliseconds, and falls back to
  // fences where they fail; the log says which. Not between the beginning and end of transform feedback, of conditional
  // rendering, or of a query other than GL_TIME_ELAPSED, which would count those draws. Errors: kDeviceFailure where GL
  // makes no objects.
  static Result<FrameTimer> create(std::optional<TimerMethod> method = std::nullopt);

  ~FrameTimer();
  FrameTimer(FrameTimer&&) noexcept;
  FrameTimer& operator=(FrameTimer&&) noexcept;

  TimerMethod method() const;

  // Enclose the GL calls of a frame; never nested. begin() returns false, and the frame stays untimed, while
  // kRing frames are under way; end() then does nothing.
  bool begin(std::uint64_t frame, Extent render);
  void end();

  // Returns the oldest frame that has come back, once each; nothing while there is none. Call until it returns nothing.
  // Frames whose time the driver reports as invalid stay untimed. Frames of a lost context never come back.
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

  // Creates a timer. `method`: FrameTimer::method() of this context. `every`: with kFence one of so many parts is
  // timed; at least 1. Errors: kInvalidArgument; kDeviceFailure where GL makes no objects.
  static Result<PartTimer> create(TimerMethod method, int every = 1);

  ~PartTimer();
  PartTimer(PartTimer&&) noexcept;
  PartTimer& operator=(PartTimer&&) noexcept;

  // Enclose the GL calls of the part, at most once a frame. A part that is not timed costs nothing and never comes
  // back: with kFence those between the timed ones, else those while kRing are under way.
  void begin(std::uint64_t frame, Extent extent);
  void end();

  // Returns the oldest part that has come back, once each; nothing while there is none. `render_extent` is the part's.
  std::optional<TimedFrame> poll();

 private:
  struct QUINCUNX_HIDDEN Impl;
  explicit PartTimer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace quincunx::gl
