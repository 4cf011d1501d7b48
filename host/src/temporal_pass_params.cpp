// SPDX-License-Identifier: MIT
#include "temporal_pass_params.h"

namespace quincunx {

int shaded_parity(const PlanFacts& facts, const FrameInputs& frame) {
  return facts.fills() ? frame.parity : -1;
}

TemporalParams temporal_params(const PassFrame& frame, const WorkShape& shape, const PlanFacts& facts) {
  const Extent output = frame.output;
  const Extent now = frame.current.render;
  const Extent before = frame.previous.render;
  const Extent tiles = extent_of(Area::kTiles, frame.extents());
  const Ratio spacing = ratio_of(output, now);
  const Ratio motion = ratio_of(output, before);
  return {.output_width = output.width,
          .output_height = output.height,
          .frame0 = {now.width, now.height, layout_of(frame[Resource::kColour]), {}, {}},
          .frame1 = {before.width, before.height, {}, {}, {}},
          .reprojection = layout_of(frame[Resource::kReprojection]),
          .output = {},
          .columns = position_columns(output),
          .counter = frame.counter.index,
          .columns_per_item = columns_per_item(shape, output.width, kTemporalTile),
          .rows_per_item = rows_per_item(shape),
          .motion_x = motion.x,
          .motion_y = motion.y,
          .spacing_x = spacing.x,
          .spacing_y = spacing.y,
          .tiles_x = tiles.width,
          .tiles_y = tiles.height,
          .parity = shaded_parity(facts, frame.current)};
}

int rows_per_item(const WorkShape& shape) {
  return shape.pixels_per_item == 0 ? kTemporalTile : 1;
}

TemporalDisplayParams temporal_display_params(const PassFrame& frame, const WorkShape& shape,
                                              Resource picture) {
  return {.output_width = frame.output.width,
          .output_height = frame.output.height,
          .output = layout_of(frame[picture]),
          .tiles_x = extent_of(Area::kTiles, frame.extents()).width,
          .columns_per_item = columns_per_item(shape, frame.output.width, kTemporalTile),
          .rows_per_item = rows_per_item(shape),
          .first = frame.has_history ? 0 : 1};
}

}  // namespace quincunx
