// SPDX-License-Identifier: MIT
// Replays a load trace through a controller on a simulated display with vertical synchronisation.
//
// The graphics processor draws one frame after the other into one of `buffers` buffers; a frame waits until
// its buffer has left the screen, and is shown at the first refresh after it is finished. A refresh at which
// no new frame is ready is a dropped frame. The timing of a frame comes `timer_latency_frames` frames later: frame n
// is sized knowing those up to n - timer_latency_frames, together with the queue as it was when the last of them was
// finished.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "bench/harness/records.h"
#include "bench/traces/load_trace.h"
#include "quincunx/control/resolution_controller.h"

namespace quincunx::traces {

struct Display {
  double refresh_hz = 60;
  int buffers = 3;               // 2 or more
  int timer_latency_frames = 1;  // frames, at least 1

  double target_ms() const { return 1000 / refresh_hz; }
};
QUINCUNX_FIELDS(Display, refresh_hz, buffers, timer_latency_frames)

struct ReplayedFrame {
  Extent render = {};
  double area = 0;         // fraction of the output's
  double oracle_area = 0;  // largest rung that fits the target, knowing the load and the noise
  double gpu_ms = 0;
  double cpu_ms = 0;
  double interval_ms = 0;
  int queued = 0;
  int dropped = 0;        // refreshes missed just before this frame was shown
  bool cpu_late = false;  // it waited for the processor, so that the drops are not the controller's
};

// The program of a replay: it sizes the frames and adds its own cost to their load.
struct ReplayedProgram {
  const ResolutionLadder& ladder;
  std::function<void(const FrameTiming&)> observe;
  std::function<Extent(std::size_t index)> next;  // frame `index` is drawn now; once for each, in order
  // The cost of the frame that next() has just sized.
  std::function<double()> besides_ms = [] { return 0.0; };
};

std::vector<ReplayedFrame> replay(const LoadTrace& trace, const Display& display,
                                  const ReplayedProgram& program);
std::vector<ReplayedFrame> replay(const LoadTrace& trace, const Display& display,
                                  ResolutionController& controller);

// Returns the area of the largest rung for which `fits` holds, which does for all smaller ones; the lowest rung's where
// it holds for none.
double largest_area(const ResolutionLadder& ladder, const std::function<bool(double area)>& fits);

// Every controller starts at the top of the ladder; the first frames, until it has found its level, do not
// count.
constexpr int kWarmUp = 60;

// Figures of a trace, or their means.
struct ReplayScore {
  int frames = 0;      // that count, of one seed
  double dropped = 0;  // refreshes without a new frame, but for those that wait for the processor
  double cpu_dropped = 0;
  double pixels_over_oracle = 0;  // mean area over the oracle's mean area
  double changes_per_second = 0;
  double reversals_per_second = 0;  // changes against the direction of the previous one
  // Until the extent stays near its final one after a step of the load up or down; absent where there is no step.
  std::optional<double> settle_up_frames = {};
  std::optional<double> settle_down_frames = {};

  double dropped_per_thousand() const { return frames > 0 ? 1000 * dropped / frames : 0; }
};

ReplayScore score(const LoadTrace& trace, const Display& display, const std::vector<ReplayedFrame>& frames);

}  // namespace quincunx::traces
