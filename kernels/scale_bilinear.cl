// SPDX-License-Identifier: MIT
// scale_bilinear: each output pixel is the bilinear mean of the four samples around its centre.
//   params      in   extents and layouts
//   axes        in   AxisTap of each output column, then of each output row; jitter is in them
//   source      in   RGBA16F or RGBA32F, viewport of params.source_width x source_height, linear, premultiplied
//   output      out  RGBA32F or RGBA16F, output extent
//   non_finite  out  non_finite[params.counter] grows by the pixels with a NaN or infinite sample of non-zero weight
// Options: SOURCE_STORAGE, SOURCE_FORMAT, OUTPUT_FORMAT as in texel.h
// Above scale 1 it still reads four samples: it does not average what lies between output pixels.
// Reference: tests/reference/scale_bilinear.cpp
#include "bilinear.h"

__kernel void scale_bilinear(const ScaleParams params, __global const AxisTap* axes, COLOUR_TEXELS source,
                             OUTPUT_TEXELS output, __global uint* non_finite) {
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  if (x >= params.output_width || y >= params.output_height) return;

  bool met_non_finite;
  const float4 colour = sample_bilinear(source, params.source, params.source_width, params.source_height, axes[x],
                                        axes[params.output_width + y], &met_non_finite);
  if (met_non_finite) atomic_inc(non_finite + params.counter);
  store_output(output, params.output, x, y, colour);
}
