// SPDX-License-Identifier: MIT
// read_targets: a frame's render targets as host memory, for files and tests. Waits for GL; never used in a
// frame that must be fast.
#pragma once

#include <cstdint>
#include <vector>

#include "quincunx/advanced/export.h"
#include "quincunx_gl/render_targets.h"

namespace quincunx::gl {

// The top left `render_extent` of each target, tightly packed, top row first; empty for targets that do not exist.
struct TargetPixels {
  Extent render_extent;
  std::vector<std::uint16_t> colour;    // RGBA, half; empty where the targets encode it
  std::vector<std::uint8_t> codes;      // RGBA8, sRGB encoded; empty where they do not
  std::vector<float> depth;             // reversed infinite
  std::vector<std::uint16_t> velocity;  // RG, half, uv
  std::vector<std::uint8_t> reactive;
};

// `render` must lie within the targets' extent.
QUINCUNX_API TargetPixels read_targets(const RenderTargets& targets, Extent render);

}  // namespace quincunx::gl
