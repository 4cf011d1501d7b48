// SPDX-License-Identifier: MIT
// Jitter: the patterns by which the samples move from frame to frame. Pure; thread-safe.
#pragma once

#include <cstdint>

#include "quincunx/advanced/extent.h"

namespace quincunx::tools {

enum class Jitter : std::uint8_t {
  kNone,
  kQuincunx,      // (-1/4, -1/4) in even frames, (1/4, 1/4) in odd ones
  kQuincunxHalf,  // (0, 0) in even frames, (1/2, 1/2) in odd ones
  kHalton,        // jitter() of quincunx/frame.h
};

const char* name_of(Jitter jitter);

// Jitter of a frame in render pixels; index >= 0. The extents decide the number of Halton's places.
Vec2 jitter_of(Jitter jitter, std::int64_t index, Extent render, Extent output);

}  // namespace quincunx::tools
