// SPDX-License-Identifier: MIT
#include "layer_params.h"

#include "resolve_params.h"

namespace quincunx {

namespace {

// Where a frame's samples lie.
struct SamplePlaces {
  Ratio spacing;
  Ratio start;
};

SamplePlaces places_of(const FrameInputs& frame, Extent output) {
  const Ratio spacing = ratio_of(output, frame.render);
  return {spacing, {(.5f + frame.jitter.x) * spacing.x, (.5f + frame.jitter.y) * spacing.y}};
}

}  // namespace

LayerParams layer_params(const PassFrame& frame, const WorkShape& shape, Extent extent) {
  const FrameInputs& current = frame.current;
  const Extent render = current.render;
  const Extent before = frame.previous.render;
  const Extent tiles = extent_of(Area::kTiles, frame.extents());
  const SamplePlaces now = places_of(current, frame.output);
  const SamplePlaces previous = places_of(frame.previous, frame.output);
  const VelocityScale motion = velocity_scale_to(current, frame.output);
  const Ratio to_previous = ratio_of(before, frame.output);
  return {.width = render.width,
          .height = render.height,
          .previous_width = before.width,
          .previous_height = before.height,
          .velocity = layout_of(frame[Resource::kVelocity]),
          .depth = layout_of(frame[Resource::kDepth]),
          .reprojection = layout_of(frame[Resource::kReprojection]),
          .spacing_x = now.spacing.x,
          .spacing_y = now.spacing.y,
          .start_x = now.start.x,
          .start_y = now.start.y,
          .previous_spacing_x = previous.spacing.x,
          .previous_spacing_y = previous.spacing.y,
          .previous_start_x = previous.start.x,
          .previous_start_y = previous.start.y,
          .motion_x = static_cast<float>(-motion.x),
          .motion_y = static_cast<float>(-motion.y),
          .to_previous_x = to_previous.x,
          .to_previous_y = to_previous.y,
          .tiles_x = tiles.width,
          .tiles_y = tiles.height,
          .columns_per_item = columns_per_item(shape, extent.width, kReprojectedBlock)};
}

LayerPastParams layer_past_params(const FrameInputs& frame, Extent output, TexelLayout depth0,
                                  TexelLayout depth1) {
  const SamplePlaces places = places_of(frame, output);
  return {.depth0 = depth0,
          .depth1 = depth1,
          .width = frame.render.width,
          .height = frame.render.height,
          .spacing_x = places.spacing.x,
          .spacing_y = places.spacing.y,
          .start_x = places.start.x,
          .start_y = places.start.y};
}

}  // namespace quincunx
