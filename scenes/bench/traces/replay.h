// SPDX-License-Identifier: MIT
// Replays a load trace through a controller on a simulated display with vertical synchronisation.
//
// The graphics processor draws one frame after the other into one of `buffers` buffers; a frame waits until
// its buffer has left the screen, and is shown at the first refresh after it is finished. A refresh at which
// no new frame is ready is a dropped frame. The timing of a frame comes `timer_latency` frames later: frame n
// is sized knowing those up to n - timer_latency, together with the queue as it was when the last of them was
// finished.
#pragma once

#include <vector>

#include "bench/traces/load_trace.h"
#include "quincunx/control/resolution_controller.h"

namespace quincunx::traces {

struct Display {
  double refresh_hz = 60;
  int buffers = 3;        // 2 or more
  int timer_latency = 1;  // frames, at least 1

  double target_ms() const { return 1000 / refresh_hz; }
};

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

std::vector<ReplayedFrame> replay(const LoadTrace& trace, const Display& display,
                                  ResolutionController& controller);

// The program of a replay: it sizes the frames and adds its own cost to their load.
class ReplayedProgram {
 public:
  virtual ~ReplayedProgram() = default;
  virtual const ResolutionLadder& ladder() const = 0;
  virtual void observe(const FrameTiming& timing) = 0;
  // Frame `index` is drawn now. Once for each, in order.
  virtual Extent next(std::size_t index) = 0;
  // That next() has just sized.
  virtual double besides_ms(std::size_t index) const = 0;
};
std::vector<ReplayedFrame> replay(const LoadTrace& trace, const Display& display, ReplayedProgram& program);

// Every controller starts at the top of the ladder; the first frames, until it has found its level, do not
// count.
constexpr int kWarmUp = 60;

struct ReplayScore {
  int frames = 0;   // that count
  int dropped = 0;  // without those that wait for the processor
  int cpu_dropped = 0;
  double pixels = 0;  // mean area over the oracle's mean area
  double changes_per_second = 0;
  double settle_up = -1;    // mean frames from a load step upwards until the extent stays near its final one
  double settle_down = -1;  // the same for a load step downwards; -1 where the trace has none
  double oscillation = 0;   // changes against the direction of the previous one, per second
};

ReplayScore score(const LoadTrace& trace, const Display& display, const std::vector<ReplayedFrame>& frames);

}  // namespace quincunx::traces
