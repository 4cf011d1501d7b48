// SPDX-License-Identifier: MIT
// What Renderer::draw() is given for the parts of a frame that have a resolution of their own.
#pragma once

#include <cstdint>

#include "quincunx_gl/part_timer.h"
#include "quincunx_gl/render_targets.h"

namespace quincunx::scenes {

inline constexpr float kLeastPartScale = 0.0625f;  // per axis

// The caller's. A part whose timer is null is not timed.
struct FrameParts {
  std::uint64_t frame = 0;  // its number, for the timers
  // Of what moves in the shadow map: a frame that also draws what stands still is like no other.
  gl::PartTimer* shadow_timer = nullptr;
  // Where FrameView::particles has its viewport: linear colour (alpha: coverage), reactive values if the frame's
  // targets have them, and depth of the surfaces behind.
  const gl::RenderTargets* particles = nullptr;
  gl::PartTimer* particle_timer = nullptr;
};

}  // namespace quincunx::scenes
