// SPDX-License-Identifier: MIT
// ResolutionController: chooses the render extent of the next frame from the times of past ones.
//
// All controllers have the ladder that they choose from, the target, and the checks of their input in common.
// A controller is pure: it has no clock, no device and no random numbers, so that the same calls in the same
// order give the same extents on every machine. Not thread safe: one thread at a time calls an object.
//
//   Result<std::unique_ptr<ResolutionController>> controller = make_predictive_controller(settings);
//   each frame:  viewport.set_render(controller->next()), draw;
//                for every timer that has come back, oldest first: controller->observe(timing)
//
// Times may come back late, several at once, or not at all. Each is paired with the extent of its own frame.
#pragma once

#include <cstdint>
#include <memory>

#include "quincunx/advanced/export.h"
#include "quincunx/advanced/extent.h"
#include "quincunx/control/resolution_ladder.h"
#include "quincunx/status.h"

namespace quincunx {

// Times of one past frame. Zero, or kUnknownQueue, means unknown unless a comment says otherwise.
struct FrameTiming {
  static constexpr int kUnknownQueue = -1;

  std::uint64_t frame = 0;       // its number; rises from call to call, gaps are allowed
  std::uint64_t next_frame = 0;  // number of the frame that next() will be drawn as; 0: the one after `frame`
  Extent render_extent = {};     // the extent it was drawn at; both sides at least 1
  double gpu_ms = 0;           // busy time of its critical path, without bubbles and without waiting for the
                               // display; must be above 0
  double cpu_ms = 0;           // time the processor needed to prepare it
  double interval_ms = 0;      // from the previous frame's start on the device to its own: work and waits
  int queued = kUnknownQueue;  // finished frames not yet shown when it was finished, itself included
  int missed_vsyncs = 0;       // refreshes without a new frame before it was shown; 0 means none
  double blur_px = 0;          // mean length of its motion blur streaks in output pixels; 0 means none
};

class QUINCUNX_API ResolutionController {
 public:
  static constexpr double kMaxMs = 60000;  // no time and no target is longer

  virtual ~ResolutionController() = default;

  virtual const char* name() const = 0;  // "predictive"

  // Learns from one frame and chooses next(). Errors: kInvalidArgument for a frame number that is not above the last
  // accepted one (late or duplicate), an empty render extent, a gpu_ms outside (0, kMaxMs], or another field that is
  // negative (queued: below -1), too long or not finite. An error changes nothing, so a caller may ignore it.
  Status observe(const FrameTiming& timing);

  // Returns the extent to draw the next frame at: a rung of the ladder. Before the first observe() the highest one.
  Extent next() const { return ladder_[rung_]; }
  int rung() const { return rung_; }

  // Sets the time that a frame may take: the display's refresh interval, a multiple of it, or any other. Errors:
  // kInvalidArgument for one outside (0, kMaxMs]; the old target then stays.
  Status set_target_ms(double target_ms);
  double target_ms() const { return target_ms_; }

  const ResolutionLadder& ladder() const { return ladder_; }

 protected:
  // Takes values that were checked: see check_target().
  ResolutionController(ResolutionLadder ladder, double target_ms);
  ResolutionController(const ResolutionController&) = default;
  ResolutionController& operator=(const ResolutionController&) = default;

  static Status check_target(double target_ms);

  // Returns the next rung, which is clamped to the ladder, after a valid timing.
  virtual int choose(const FrameTiming& timing) = 0;

 private:
  Status check(const FrameTiming& timing) const;

  ResolutionLadder ladder_;
  double target_ms_;
  int rung_;
  std::uint64_t last_frame_ = 0;
  bool observed_ = false;
};

// The proportional controller of Binks, "Dynamic Resolution Rendering", 2012, "Resolution Control":
//   s <- s (1 + k (1 - t / T))
// s scales both axes and T is the target. t is the mean of gpu_ms and interval_ms. It is gpu_ms alone where the
// interval is unknown or significantly longer: that is a spike of the processor or a wait for the display.
struct ProportionalSettings {
  LadderSettings ladder = {};
  double target_ms = 1000.0 / 60;
  double rate = 0.05;        // k, in (0, 1]; the paper gives none
  double spike_ratio = 1.5;  // an interval longer than this times gpu_ms is ignored; at least 1
};
QUINCUNX_API Result<std::unique_ptr<ResolutionController>> make_proportional_controller(
    const ProportionalSettings& settings);

// The minimum-of-N controller (the draw-time tutorial for MonoGame): with m the shortest of the last N times
// and the target reduced by a margin,
//   s <- s + factor s (T' - m) / T'
//   T' = target * margin
// s scales both axes.
struct MinimumOfNSettings {
  LadderSettings ladder = {};
  double target_ms = 1000.0 / 60;
  int count = 5;         // N, in [1, 1000]; the tutorial gives none
  double factor = 0.2;   // ResolutionChangeFactor, in (0, 1]
  double margin = 0.87;  // 29 ms of 33.3, in (0, 1]
};
QUINCUNX_API Result<std::unique_ptr<ResolutionController>> make_minimum_of_n_controller(
    const MinimumOfNSettings& settings);

}  // namespace quincunx
