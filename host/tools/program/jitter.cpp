// SPDX-License-Identifier: MIT
#include "tools/program/jitter.h"

#include "quincunx/frame.h"

namespace quincunx::tools {

const char* name_of(Jitter jitter) {
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

Vec2 jitter_of(Jitter jitter, std::int64_t index, Extent render, Extent output) {
  switch (jitter) {
    case Jitter::kNone:
      return {};
    case Jitter::kQuincunx:
      return index % 2 == 0 ? Vec2{-0.25f, -0.25f} : Vec2{0.25f, 0.25f};
    case Jitter::kQuincunxHalf:
      return index % 2 == 0 ? Vec2{} : Vec2{0.5f, 0.5f};
    case Jitter::kHalton:
      return quincunx::jitter(static_cast<std::uint64_t>(index), render, output);
  }
  return {};
}

}  // namespace quincunx::tools
