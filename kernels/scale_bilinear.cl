// SPDX-License-Identifier: MIT
// scale_bilinear: each output pixel is the bilinear mean of the four samples around its centre.
//   params      in   extents and layouts
//   axes        in   AxisTap of each output column, then of each output row; jitter is in them
//   source      in   RGBA16F or RGBA32F, viewport of params.source_width x source_height, linear, premultiplied
//   output      out  RGBA32F or RGBA16F, output extent
//   non_finite  out  non_finite[params.counter] grows by the pixels with a NaN or infinite sample of non-zero weight
// Options: SOURCE_STORAGE, SOURCE_FORMAT, OUTPUT_FORMAT as in texel.h
// Above scale 1 it still reads four samples, and skips those between output pixels.
// Reference: tests/reference/scale_bilinear.cpp
#include "bilinear.h"
#include "bits.h"
#include "resolve_params.h"

__kernel void scale_bilinear(const ScaleParams params, __global const AxisTap* axes, COLOUR_TEXELS source,
                             OUTPUT_TEXELS output, __global uint* non_finite) {
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(params.columns_per_item, params.output_width, kBlock);
  if (item.first >= item.end || y >= params.output_height) return;

  const AxisTap row = axes[params.row_axis + y];
  uint bits;
  int4 largest = params.source_width > 1 ? 0 : NON_FINITE_BITS;
  if (params.source_width > 1) {
    for (int x = item.first; x < item.end; x += item.step) {
      FourPixels colour;
      sample_four(false, source, params.source, params.source_width, params.source_height, axes + x, row, &colour,
                  &bits);
      largest = largest_of(largest, colour);
      store_four(output, params.output, x, y, x + pixels_from(item, x), colour);
    }
  }
  if (!any_reached_infinity(largest)) return;

  // Rare: once more, on the slow path.
  uint met = 0;
  for (int x = item.first; x < item.end; x += item.step) {
    FourPixels colour;
    sample_four(true, source, params.source, params.source_width, params.source_height, axes + x, row, &colour, &bits);
    met += count_bits(bits, pixels_from(item, x));
    store_four(output, params.output, x, y, x + pixels_from(item, x), colour);
  }
  if (met) atomic_add(non_finite + params.counter, met);
}
