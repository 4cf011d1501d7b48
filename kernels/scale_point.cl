// SPDX-License-Identifier: MIT
// scale_point: each output pixel takes the sample nearest to its centre.
//   params      in   extents and layouts
//   axes        in   AxisTap of each output column, then of each output row; jitter is in them
//   source      in   RGBA16F or RGBA32F, viewport of params.source_width x source_height, linear, premultiplied
//   output      out  RGBA32F or RGBA16F, output extent
//   non_finite  out  non_finite[params.counter] grows by the pixels whose sample is NaN or infinite
// Options: SOURCE_STORAGE, SOURCE_FORMAT, OUTPUT_FORMAT as in texel.h
// Reference: tests/reference/scale_point.cpp
#include "bits.h"
#include "resolve_params.h"
#include "texel.h"

__kernel void scale_point(const ScaleParams params, __global const AxisTap* axes, COLOUR_TEXELS source,
                          OUTPUT_TEXELS output, __global uint* non_finite) {
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(params.columns_per_item, params.output_width, 1);
  if (item.first >= item.end || y >= params.output_height) return;

  const int row = axes[params.row_axis + y].nearest;
  for (int x = item.first; x < item.end; x += item.step) {
    float4 colour = load_colour(source, params.source, axes[x].nearest, row);
    if (any_non_finite4(colour)) {
      colour = sanitise4(colour);
      atomic_inc(non_finite + params.counter);
    }
    store_output(output, params.output, x, y, colour);
  }
}
