// SPDX-License-Identifier: MIT
// scale_noise_offset: each output pixel takes one of the four samples around its centre, at random with the weights that
// bilinear would give them: bilinear in the mean of many pixels or frames, and no blur in any one.
//   params      in   extents and layouts; seed: another seed gives another pattern. Not read: amplitude
//   axes        in   AxisTap of each output column, then of each output row; jitter is in them
//   source      in   RGBA16F or RGBA32F, viewport of params.scale.source_width x source_height, linear, premultiplied
//   output      out  RGBA32F or RGBA16F, output extent
//   non_finite  out  non_finite[params.scale.counter] grows by the pixels whose sample is NaN or infinite
// Options: SOURCE_STORAGE, SOURCE_FORMAT, OUTPUT_FORMAT as in texel.h
// The random values belong to the output pixel: jitter moves the samples under them, not them.
// Source: Binks, "Dynamic Resolution Rendering", 2012 (noise offset filtering).   Reference: tests/reference/noise.cpp
#include "hash.h"
#include "sanitise.h"
#include "texel.h"

__kernel void scale_noise_offset(const NoiseParams params, __global const AxisTap* axes, COLOUR_TEXELS source,
                                 OUTPUT_TEXELS output, __global uint* non_finite) {
  const ScaleParams scale = params.scale;
  const int y = get_global_id(1);
  const int first = get_global_id(0) * scale.columns_per_item;
  if (first >= scale.output_width || y >= scale.output_height) return;

  const int end = min(first + scale.columns_per_item, scale.output_width);
  const AxisTap row = axes[scale.row_axis + y];
  const uint row_hash = hash_of_row(y, params.seed);
  for (int x = first; x < end; x += kBlock) {
    // The axis table is padded to whole blocks.
    const AxisTap t0 = axes[x];
    const AxisTap t1 = axes[x + 1];
    const AxisTap t2 = axes[x + 2];
    const AxisTap t3 = axes[x + 3];
    const uint4 hash = hash_of4((uint4)(0, 1, 2, 3) + ((uint)x + row_hash));
    const float4 random_x = convert_float4(as_int4(hash >> 16)) * 0x1p-16f;
    const float4 random_y = convert_float4(as_int4(hash & 0xffffu)) * 0x1p-16f;
    // A comparison of vectors gives -1 where it holds.
    const int4 column = (int4)(t0.base, t1.base, t2.base, t3.base) -
                        (random_x < (float4)(t0.weight1, t1.weight1, t2.weight1, t3.weight1));
    const int4 line = row.base - (random_y < row.weight1);
    FourPixels colour;
    colour.p0 = load_colour(source, scale.source, column.s0, line.s0);
    colour.p1 = load_colour(source, scale.source, column.s1, line.s1);
    colour.p2 = load_colour(source, scale.source, column.s2, line.s2);
    colour.p3 = load_colour(source, scale.source, column.s3, line.s3);
    const uint bits = sanitise_four(&colour);
    if (bits) atomic_add(non_finite + scale.counter, count_bits(bits, end - x));
    store_four(output, scale.output, x, y, end, colour);
  }
}
