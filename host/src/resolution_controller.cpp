// SPDX-License-Identifier: MIT
#include "quincunx/resolution_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace quincunx {

ResolutionController::ResolutionController(ResolutionLadder ladder, double target_ms)
    : ladder_(std::move(ladder)), target_ms_(target_ms), rung_(ladder_.top()) {}

Status ResolutionController::check_target(double target_ms) {
  if (target_ms > 0 && target_ms <= kLongestMs) return {};
  return Status::invalid(fmt::format("target_ms is {}; it must lie in (0, {}]", target_ms, kLongestMs));
}

Status ResolutionController::set_target_ms(double target_ms) {
  if (Status status = check_target(target_ms); !status.ok()) return status;
  target_ms_ = target_ms;
  return {};
}

Status ResolutionController::check(const FrameTiming& timing) const {
  if (observed_ && timing.frame <= last_frame_) {
    return Status::invalid(
        fmt::format("frame is {}, late or a duplicate; the last one was {}", timing.frame, last_frame_));
  }
  if (timing.next_frame != 0 && timing.next_frame <= timing.frame) {
    return Status::invalid(
        fmt::format("next_frame is {}; it must be 0 or above frame, {}", timing.next_frame, timing.frame));
  }
  if (timing.render.width < 1 || timing.render.height < 1) {
    return Status::invalid(fmt::format("render is {}x{}; both sides must be at least 1", timing.render.width,
                                       timing.render.height));
  }
  if (!(timing.gpu_ms > 0 && timing.gpu_ms <= kLongestMs)) {
    return Status::invalid(fmt::format("gpu_ms is {}; it must lie in (0, {}]", timing.gpu_ms, kLongestMs));
  }
  const auto unusable = [](double value) { return !(value >= 0 && value <= kLongestMs); };
  if (unusable(timing.cpu_ms)) {
    return Status::invalid(fmt::format("cpu_ms is {}; it must lie in [0, {}]", timing.cpu_ms, kLongestMs));
  }
  if (unusable(timing.interval_ms)) {
    return Status::invalid(
        fmt::format("interval_ms is {}; it must lie in [0, {}]", timing.interval_ms, kLongestMs));
  }
  if (timing.queued < FrameTiming::kUnknownQueue) {
    return Status::invalid(
        fmt::format("queued is {}; it must be at least 0, or -1 for unknown", timing.queued));
  }
  if (timing.missed_vsyncs < 0) {
    return Status::invalid(fmt::format("missed_vsyncs is {}; it must be at least 0", timing.missed_vsyncs));
  }
  if (!(timing.blur_px >= 0 && std::isfinite(timing.blur_px))) {
    return Status::invalid(fmt::format("blur_px is {}; it must be finite and at least 0", timing.blur_px));
  }
  return {};
}

Status ResolutionController::observe(const FrameTiming& timing) {
  if (Status status = check(timing); !status.ok()) return status;
  last_frame_ = timing.frame;
  observed_ = true;
  rung_ = std::clamp(choose(timing), 0, ladder_.top());
  return {};
}

}  // namespace quincunx
