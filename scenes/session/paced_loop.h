// SPDX-License-Identifier: MIT
// PacedLoop: FramePacing with the host's clock and a FrameMeter: what a program calls around its frames.
//
//   for each frame:  loop.wait();
//                    const Extent render = loop.next().value_or(chosen otherwise);
//                    loop.begin_frame(render);  draw;  loop.end_draw();
//                    resolve, present;
//                    loop.finish_frame();
//                    loop.add(report) for every FrameReport that has come back, oldest first
//
// Where overlaps(), the next frame may be drawn before this one is finished, if ready().
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "quincunx/advanced/pass_timer.h"
#include "quincunx/frame.h"
#include "quincunx_gl/frame_timer.h"
#include "session/frame_pacing.h"
#include "tools/program/clock.h"

namespace quincunx::scenes {

// Milliseconds of all passes together, and of those that a method has and others have not: without motion blur, the
// present pass and measure_content. 0 where the time of one is not known.
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

// Measures the cost of each frame, for a resolution controller. Where the timers of OpenGL (see FrameTimer) and of
// OpenCL (see pass_timer.h) tell the truth, a frame costs what the devices worked on it: OpenGL's time and the times of
// the OpenCL passes. Where they do not, as on software renderers, it costs what it added to the run:
// FramePacing::busy_ms(). There OpenGL, OpenCL and this program share the same cores, and frames have to be drawn one
// after the other for the times to belong to one frame each.
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
    double method_ms = 0;  // the method's share of `ms`: see PassTimes
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

class PacedLoop {
 public:
  // `pacing` has no frames yet. `passes`: of the OpenCL device. Errors: of FrameMeter::create(). One thread,
  // that of the GL context.
  static Result<PacedLoop> create(FramePacing pacing, FrameCost cost, PassTimer passes);

  // The next frame may be drawn before this one is finished, because no frame's span is measured.
  bool overlaps() const { return !pacing_.has_display() || meter_.measures_device(); }

  bool ready() const;  // the next frame has a buffer
  void wait() const;   // sleeps until ready(); not where that depends on a frame that is not finished

  std::optional<Extent> next() const { return pacing_.next(); }  // nothing: the caller chooses
  std::optional<QualityChoice> choice() const { return pacing_.choice(); }

  // blur_px: see FrameTiming. detail: for the report only.
  void begin_frame(Extent render, double blur_px = 0, int detail = 0);
  void end_draw();                      // after the OpenGL calls of the frame begun last
  void finish_frame();                  // the picture of the oldest unfinished frame is complete
  void add(const FrameReport& report);  // its frame_index: the frame's number in this loop

  // The time between these is no part of the run: the display stands still. While no frame is under way.
  void stop_clock() { stopped_ = tools::Clock::now(); }
  void start_clock() { start_ += tools::Clock::now() - stopped_; }

  const FramePacing& pacing() const { return pacing_; }
  tools::PacingRun run() const;

 private:
  PacedLoop(FramePacing pacing, FrameMeter meter) : pacing_(std::move(pacing)), meter_(std::move(meter)) {}
  double now_ms() const;

  FramePacing pacing_;
  FrameMeter meter_;
  tools::Clock::time_point start_ = tools::Clock::now();
  tools::Clock::time_point stopped_;
  double cpu_at_begin_ms_ = 0;
  std::deque<double> cpu_ms_;  // processor times of the frames that are not finished
};

}  // namespace quincunx::scenes
