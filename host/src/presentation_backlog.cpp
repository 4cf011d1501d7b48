// SPDX-License-Identifier: MIT
#include "presentation_backlog.h"

#include <algorithm>
#include <cmath>

namespace quincunx {

void PresentationBacklog::observe(const Frame& frame, double refresh_ms) {
  const double least_wait = 0.02 * refresh_ms;
  const double most = slack(refresh_ms);
  if (!certain_ && frame.queued >= 0) backlog_ = most;
  backlog_ = std::clamp(backlog_, 0.0, most);
  const bool waited = last_gpu_ms_ > 0 && frame.interval_ms > last_gpu_ms_ + least_wait;
  last_gpu_ms_ = frame.gpu_ms;
  if (waited) {
    // For the display, because the queue was full; or for the processor, while the queue ran empty.
    certain_ = frame.cpu_ms < frame.interval_ms - least_wait;
    backlog_ = certain_ ? 0 : most;
  }
  backlog_ = std::max(0.0, backlog_ + frame.gpu_ms - refresh_ms);
  if (frame.missed_vsyncs > 0 && backlog_ < most) certain_ = false;
  if (backlog_ > most) backlog_ = most > 0 ? std::fmod(backlog_, refresh_ms) : 0;
  if (frame.queued < 0) return;
  // With q frames waiting, the backlog lies between the two multiples of the interval that q stands for.
  const double highest = (buffers_ - 1.0 - frame.queued) * refresh_ms;
  backlog_ = std::clamp(certain_ ? backlog_ : most, std::clamp(highest - refresh_ms, 0.0, most),
                        std::clamp(highest, 0.0, most));
  certain_ = certain_ || frame.queued >= buffers_ - 1;
}

}  // namespace quincunx
