// SPDX-License-Identifier: MIT
// FrameMeter: what each frame cost, for a resolution controller.
//
// Where the timers of OpenGL (see FrameTimer) and of OpenCL (see pass_timer.h) tell the truth, a frame costs what
// the devices worked on it: OpenGL's time and the times of the OpenCL passes. Where they do not, as on software
// renderers, it costs what it added to the run: FramePacing::busy_ms(). There OpenGL, OpenCL and this program share
// the same cores, and frames have to be drawn one after the other for the times to belong to one frame each.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "quincunx/frame.h"
#include "quincunx/pass_timer.h"
#include "quincunx_gl/frame_timer.h"

namespace quincunx::scenes {

// Milliseconds of all passes together, and of those that a method has and others have not: without motion blur, the
// present pass and that which measures content. 0 where one's time is not known.
struct PassTimes {
  double all_ms = 0;
  double method_ms = 0;
};
PassTimes pass_times(const FrameReport& report);

enum class FrameCost : std::uint8_t {
  kAuto,    // kDevice where the timers can be trusted, else kSpan
  kDevice,  // what the devices worked, whatever the timers are worth
  kSpan,    // from beginning to end
};

class FrameMeter {
 public:
  // `passes`: what times the OpenCL passes. Errors: kUnsupported for kDevice where that is not their events; those of
  // FrameTimer::create(). One thread, that of the GL context.
  static Result<FrameMeter> create(FrameCost cost, PassTimer passes);

  bool measures_device() const { return timer_.has_value(); }
  std::string method() const;  // one clause, for the report

  // Around the OpenGL calls of a frame. Nothing happens with kSpan.
  void begin(std::uint64_t frame, Extent render);
  void end();

  // The OpenCL passes of a frame are done. Nothing happens with kSpan.
  void add(const FrameReport& report);

  struct Cost {
    std::uint64_t frame = 0;
    double ms = 0;
    double method_ms = 0;  // of `ms`: see PassTimes
    std::optional<ContentStatistics> content = {};
  };
  // The oldest frame of which both times have come back, once each. Call until it says nothing. Frames of
  // which one time was lost are left out. Never any with kSpan.
  std::optional<Cost> next();

 private:
  explicit FrameMeter(std::optional<gl::FrameTimer> timer) : timer_(std::move(timer)) {}

  std::optional<gl::FrameTimer> timer_;  // with kDevice only
  std::deque<Cost> gl_;
  std::deque<Cost> cl_;
};

}  // namespace quincunx::scenes
