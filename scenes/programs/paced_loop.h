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

#include "programs/frame_meter.h"
#include "programs/frame_pacing.h"
#include "tools/program/clock.h"

namespace quincunx::scenes {

class PacedLoop {
 public:
  // `pacing` has no frames yet. `passes`: of the OpenCL device. Errors: of FrameMeter::create(). One thread,
  // that of the GL context.
  static Result<PacedLoop> create(FramePacing pacing, FrameCost cost, PassTimer passes);

  bool overlaps() const { return meter_.measures_device(); }

  bool ready() const;  // the next frame has a buffer
  void wait() const;   // sleeps until ready(); not where that depends on a frame that is not finished

  std::optional<Extent> next() const { return pacing_.next(); }  // nothing: the caller chooses
  std::optional<QualityChoice> choice() const { return pacing_.choice(); }

  // blur_px: see FrameTiming. detail: for the report only.
  void begin_frame(Extent render, double blur_px = 0, int detail = 0);
  void end_draw();                      // after the OpenGL calls of the frame begun last
  void finish_frame();                  // the picture of the oldest unfinished frame is complete
  void add(const FrameReport& report);  // its frame_index: the frame's number in this loop

  // What happens between these is no part of the run: the display stands still. While no frame is under way.
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
  std::deque<double> cpu_ms_;  // of the frames that are not finished
};

}  // namespace quincunx::scenes
