// SPDX-License-Identifier: MIT
// Change maps: where a picture changes from one frame to the next as it should not. Pure; thread-safe.
#pragma once

#include <span>
#include <vector>

#include "tools/image/image_metrics.h"

namespace quincunx::tools {

// For each pixel |(picture - previous) - (truth - previous_truth)| of luma, whose mean is flicker(). All of one extent.
std::vector<float> flicker_map(const MeasuredPicture& picture, const MeasuredPicture& previous,
                               const MeasuredPicture& truth, const MeasuredPicture& previous_truth);

// uv velocity of a frame (this position - previous position, +v down), rows top-down; as many as the extent's area.
struct MotionField {
  Extent extent;
  std::span<const Vec2> velocity;
};

// For each pixel |picture - previous| of luma, previous read (bilinear) where motion says that the pixel was; 0 where
// that is off screen. Trails and ghosts show, and whatever motion does not explain: what is uncovered, changes of
// light, edges that alias otherwise.
std::vector<float> ghost_map(const MeasuredPicture& picture, const MeasuredPicture& previous,
                             const MotionField& motion);

}  // namespace quincunx::tools
