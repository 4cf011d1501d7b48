// SPDX-License-Identifier: MIT
// What the parts of a frame that have a resolution of their own may be drawn at, and by whom they are timed.
#pragma once

#include <cstdint>

#include "quincunx_gl/part_timer.h"

namespace quincunx::scenes {

inline constexpr float kLeastPartScale = 0.0625f;  // per axis

// Timers of a frame's parts; null: the part is not timed. The caller's.
struct PartTimers {
  std::uint64_t frame = 0;  // its number, for the timers
  // Of what moves in the shadow map: a frame that also draws what stands still is like no other.
  gl::PartTimer* shadow = nullptr;
};

}  // namespace quincunx::scenes
