// SPDX-License-Identifier: MIT
#include "passes/frame_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "quincunx/advanced/log.h"

namespace quincunx {

void FrameAdvice::look_at(const ResolvePlan& plan, const FrameInputs& inputs) {
  if (inputs.reset) return;
  if (looks_at_camera_) look_at_camera(inputs.camera);
  const Extent output = inputs.output_extent == Extent{} ? plan.settings.output_extent : inputs.output_extent;
  if (plan.accumulates() && plan.reads_history(inputs.render_extent, output))
    look_at_jitter(inputs.render_extent, output, inputs.jitter);
}

void FrameAdvice::look_at_camera(const CameraMotion& camera) {
  looks_at_camera_ = camera.clip_to_previous_clip == CameraMotion{}.clip_to_previous_clip;
  if (!looks_at_camera_ || ++camera_frames_ < kFrames) return;
  looks_at_camera_ = false;
  log_line(
      LogLevel::kWarning,
      fmt::format("the plan reads the camera's motion, but in the first {} frames `camera` is the identity, "
                  "as of one that stands still; where it moves, tell how",
                  kFrames));
}

void FrameAdvice::look_at_jitter(Extent render, Extent output, Vec2 jitter) {
  constexpr float kSamePlace = .01f;
  if (place_count_ == places_.size() || jitter_frames_ == kFrames) return;
  const auto end = places_.begin() + place_count_;
  const bool is_known = std::any_of(places_.begin(), end, [&](Vec2 place) {
    return std::abs(place.x - jitter.x) <= kSamePlace && std::abs(place.y - jitter.y) <= kSamePlace;
  });
  if (!is_known) places_[place_count_++] = jitter;
  const int wanted = jitter_phases(render, output);
  if (++jitter_frames_ < kFrames || 2 * place_count_ >= static_cast<std::size_t>(wanted) ||
      place_count_ == places_.size())
    return;
  log_line(
      LogLevel::kWarning,
      fmt::format("the first {} frames have samples at {} {} of a pixel, where temporal wants {}: `jitter` "
                  "is not as jitter(frame, {}x{}, {}x{}) gives it, and pictures stay coarse",
                  kFrames, place_count_, place_count_ == 1 ? "place" : "places", wanted, render.width,
                  render.height, output.width, output.height));
}

}  // namespace quincunx
