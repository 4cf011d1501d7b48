// SPDX-License-Identifier: MIT
// FrameAdvice: faults that no frame shows by itself, because each is right for one frame: what the first ones have in
// common. Each is said once, as a warning of the log.
#pragma once

#include <array>
#include <cstddef>

#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

class FrameAdvice {
 public:
  static constexpr int kFrames = 32;  // looked at before anything is said

  explicit FrameAdvice(const ResolvePlan& plan) : looks_at_camera_(plan.reads_camera()) {}

  // Allocates only where it warns. `inputs`: a frame that was dispatched by `plan`.
  void look_at(const ResolvePlan& plan, const FrameInputs& inputs);

 private:
  void look_at_camera(const CameraMotion& camera);
  void look_at_jitter(Extent render, Extent output, Vec2 jitter);

  bool looks_at_camera_;
  int camera_frames_ = 0;
  int jitter_frames_ = 0;
  std::array<Vec2, 8> places_;  // of the jitter; more than fit are enough
  std::size_t place_count_ = 0;
};

}  // namespace quincunx
