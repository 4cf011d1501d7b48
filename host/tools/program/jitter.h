// SPDX-License-Identifier: MIT
// Jitter: the patterns by which the samples move from frame to frame. Pure; thread-safe.
#pragma once

#include <cstdint>

#include "quincunx/extent.h"

namespace quincunx::tools {

enum class Jitter : std::uint8_t {
  kNone,
  kQuincunx,      // (-1/4, -1/4) in even frames, (1/4, 1/4) in odd ones
  kQuincunxHalf,  // (0, 0) in even frames, (1/2, 1/2) in odd ones
  kHalton,        // Halton (2, 3) about its mean, as many phases as the scale needs
};

const char* name_of(Jitter jitter);

// Jitter of a frame in render pixels; index >= 0. `ratio`: render / output, decides the number of Halton
// phases, ceil(8 / (x y)).
Vec2 jitter_of(Jitter jitter, std::int64_t index, Vec2 ratio);

}  // namespace quincunx::tools
