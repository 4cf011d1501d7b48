// SPDX-License-Identifier: MIT
#include "filter_params.h"

#include <algorithm>

namespace quincunx {
namespace {

// Output pixels, in whole blocks, whose columns fit into the kernel's array: the first and the last pixel of
// a run of n are (n - 1) * render / output texels apart, and both may round.
int run_length(int render, int output, int taps, int columns) {
  const double step = static_cast<double>(render) / output;
  const int fitting = static_cast<int>((kFilterColumns - taps - 1) / step) + 1;
  return std::min(fitting / kBlock * kBlock, columns);
}

}  // namespace

FilterParams filter_params(const Filter& filter, const WorkShape& shape, const FilterPicture& from,
                           const FilterPicture& to, const Counter& counter) {
  const Extent render = from.extent;
  const Extent extent = to.extent;
  const int taps_x = filter_taps(filter, render.width, extent.width);
  const int taps_y = filter_taps(filter, render.height, extent.height);
  const int columns = columns_per_item(shape, extent.width);
  const bool narrow = render.width < std::max<int>(taps_x, kBlock) || render.height < taps_y;
  return {.output_width = extent.width,
          .output_height = extent.height,
          .source_width = render.width,
          .source_height = render.height,
          .source = layout_of(from.view),
          .output = layout_of(to.view),
          .row_axis = padded_columns(extent),
          .taps_x = taps_x,
          .taps_y = taps_y,
          .inner_x = filter_inner(render.width, extent.width),
          .inner_y = filter_inner(render.height, extent.height),
          .run = narrow ? 0 : std::max(run_length(render.width, extent.width, taps_x, columns), 0),
          .counter = counter.index,
          .columns_per_item = columns};
}

}  // namespace quincunx
