// SPDX-License-Identifier: MIT
#include "motion_params.h"

#include <bit>

namespace quincunx {
namespace {

int log2_of(int power) {
  return std::bit_width(static_cast<unsigned>(power)) - 1;
}

// From the units of the velocity target to streaks: a frame's motion in output pixels, times the open part of
// the frame.
Vec2 streak_scale(const FrameInputs& inputs, Extent output, float shutter) {
  const VelocityScale pixels = velocity_scale_to(inputs, output);
  const double units = static_cast<double>(shutter) * static_cast<int>(kStreakUnits);
  return {static_cast<float>(units * pixels.x), static_cast<float>(units * pixels.y)};
}

}  // namespace

MotionParams motion_params(const PassFrame& frame, const WorkShape& shape,
                           const MotionBlurSettings& settings) {
  const Extent grid = extent_of(Area::kBlurTiles, frame.extents());
  const Vec2 scale = streak_scale(frame.current, frame.output, settings.shutter);
  return {.output_width = frame.output.width,
          .output_height = frame.output.height,
          .tiles_x = grid.width,
          .tiles_y = grid.height,
          .source = layout_of(frame[Resource::kResolved]),
          .velocity = layout_of(frame[Resource::kVelocity]),
          .depth = layout_of(frame[Resource::kDepth]),
          .output = layout_of(frame[Resource::kBlurred]),
          .row_axis = padded_columns(frame.output),
          .columns_per_item = columns_per_item(shape, frame.output.width),
          .most_samples_log2 = log2_of(settings.samples),
          .scale_x = scale.x,
          .scale_y = scale.y};
}

}  // namespace quincunx
