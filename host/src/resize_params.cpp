// SPDX-License-Identifier: MIT
#include "resize_params.h"

#include <algorithm>
#include <cmath>

#include "temporal/tile.h"

namespace quincunx {
namespace {

// Of a pixel on one axis at which history is read: its centre, but where history is clearly denser as many as there
// are texels, so that none is skipped.
int places_of(int previous, int output) {
  constexpr double kDenser = 1.5;
  constexpr double kMost = 4;
  const double ratio = static_cast<double>(previous) / output;
  return ratio <= kDenser ? 1 : static_cast<int>(std::min(std::ceil(ratio), kMost));
}

// Confidence that is left at most: as of all history that was resampled; where the output grows less, because history
// cannot have the detail that is to come.
constexpr float kResampled = 8;
constexpr float kGrown = 1;

}  // namespace

ResizeParams resize_params(const PassFrame& frame, const WorkShape& shape) {
  const Extent output = frame.output;
  const Extent before = frame.previous_output;
  const Extent tiles = extent_of(Area::kTiles, frame.extents());
  const Extent tiles_before = extent_of(Area::kPreviousTiles, frame.extents());
  const Ratio ratio = ratio_of(before, output);
  const double texels_a_pixel = static_cast<double>(before.area()) / static_cast<double>(output.area());
  return {.width = output.width,
          .height = output.height,
          .previous_width = before.width,
          .previous_height = before.height,
          .tiles_x = tiles.width,
          .tiles_y = tiles.height,
          .previous_tiles_x = tiles_before.width,
          .previous_tiles_y = tiles_before.height,
          .columns = position_columns(output),
          .columns_per_item = columns_per_item(shape, output.width, kTemporalTile),
          .ratio_x = ratio.x,
          .ratio_y = ratio.y,
          .places_x = places_of(before.width, output.width),
          .places_y = places_of(before.height, output.height),
          .share = static_cast<float>(std::min(texels_a_pixel, 1.0)),
          .most = texels_a_pixel < 1 ? kGrown : kResampled};
}

TableKey resize_key(const PassFrame& frame) {
  return {frame.output, frame.previous_output, {}};
}

}  // namespace quincunx
