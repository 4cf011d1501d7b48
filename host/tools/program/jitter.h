// SPDX-License-Identifier: MIT
// Jitter: the patterns by which the samples move from frame to frame. Pure; thread-safe.
#pragma once

#include <cstdint>

#include "quincunx/advanced/extent.h"
#include "quincunx/frame.h"

namespace quincunx::tools {

enum class Jitter : std::uint8_t {
  kNone,
  kQuincunx,      // (-1/4, -1/4) in even frames, (1/4, 1/4) in odd ones
  kQuincunxHalf,  // (0, 0) in even frames, (1/2, 1/2) in odd ones
  kHalton,        // jitter() of quincunx/frame.h
};

inline const char* name_of(Jitter jitter) {
  switch (jitter) {
    case Jitter::kNone:
      return "none";
    case Jitter::kQuincunx:
      return "quincunx";
    case Jitter::kQuincunxHalf:
      return "quincunx-half";
    case Jitter::kHalton:
      return "halton";
  }
  return "unknown";
}

// Jitter of a frame in render pixels. The extents decide how many places Halton has. Indices below 0 go on backwards.
inline Vec2 jitter_of(Jitter jitter, std::int64_t index, Extent render, Extent output) {
  switch (jitter) {
    case Jitter::kNone:
      return {};
    case Jitter::kQuincunx:
      return index % 2 == 0 ? Vec2{-0.25f, -0.25f} : Vec2{0.25f, 0.25f};
    case Jitter::kQuincunxHalf:
      return index % 2 == 0 ? Vec2{} : Vec2{0.5f, 0.5f};
    case Jitter::kHalton:
      if (const auto places = static_cast<std::int64_t>(jitter_phases(render, output)); index < 0)
        index = places - 1 - (-1 - index) % places;
      return quincunx::jitter(static_cast<std::uint64_t>(index), render, output);
  }
  return {};
}

}  // namespace quincunx::tools
