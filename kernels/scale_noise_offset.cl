// SPDX-License-Identifier: MIT
// scale_noise_offset: each output pixel takes one sample, at a random place of a square around the pixel's centre. The
// square is a texel wide, so that the four samples around the centre have bilinear's weights as probabilities: bilinear
// in the mean of many pixels or frames, and no blur in any one. Above scale 1 the square is as wide as the output
// pixel.
//   params      in   extents and layouts; seed: another seed gives another pattern; reach: the square. Not read:
//                    amplitude
//   axes        in   AxisTap of each output column, then of each output row; jitter is in them
//   source      in   RGBA16F or RGBA32F, viewport of params.scale.source_width x source_height, linear, premultiplied
//   output      out  RGBA32F or RGBA16F, output extent
//   non_finite  out  non_finite[params.scale.counter] grows by the pixels whose sample is NaN or infinite
// Options: SOURCE_STORAGE, SOURCE_FORMAT, OUTPUT_FORMAT as in texel.h
// The random values belong to the output pixel; jitter moves the samples under them.
// Source: Binks, "Dynamic Resolution Rendering", 2012 (noise offset filtering).   Reference: tests/reference/noise.cpp
#include "bits.h"
#include "resolve_params.h"
#include "texel.h"

// The texel of each of four places: `weight` texels right of the centre of `base`, moved by random * reach, random in 0
// to 65535. In 2^-24 texels, so that no rounding moves a place.
static inline int4 texels_at(int4 base, float4 weight, int4 random, int reach, int last) {
  const int4 place = convert_int4(weight * 0x1p24f) + (random - 0x8000) * reach + 0x800000;
  return clamp(base + (place >> 24), (int4)(0), (int4)(last));
}

__kernel void scale_noise_offset(const NoiseParams params, __global const AxisTap* axes, COLOUR_TEXELS source,
                                 OUTPUT_TEXELS output, __global uint* non_finite) {
  const ScaleParams scale = params.scale;
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(scale.columns_per_item, scale.output_width, kBlock);
  if (item.first >= item.end || y >= scale.output_height) return;

  const AxisTap row = axes[scale.row_axis + y];
  const uint row_hash = hash_of_row(y, params.seed);
  for (int x = item.first; x < item.end; x += item.step) {
    const int count = pixels_from(item, x);
    // The axis table is padded to whole blocks.
    const AxisTap t0 = axes[x];
    AxisTap t1 = t0, t2 = t0, t3 = t0;
    if (LANES == 8) {
      t1 = axes[x + 1];
      t2 = axes[x + 2];
      t3 = axes[x + 3];
    }
    const uint4 hash = hash_of4((uint4)(0, 1, 2, 3) + ((uint)x + row_hash));
    const int4 column = texels_at((int4)(t0.base, t1.base, t2.base, t3.base),
                                  (float4)(t0.weight1, t1.weight1, t2.weight1, t3.weight1), as_int4(hash >> 16),
                                  params.reach_x, scale.source_width - 1);
    const int4 line = texels_at((int4)(row.base), (float4)(row.weight1), as_int4(hash & 0xffffu), params.reach_y,
                                scale.source_height - 1);
    FourPixels colour;
    colour.p0 = load_colour(source, scale.source, column.s0, line.s0);
    if (LANES == 8) {
      colour.p1 = load_colour(source, scale.source, column.s1, line.s1);
      colour.p2 = load_colour(source, scale.source, column.s2, line.s2);
      colour.p3 = load_colour(source, scale.source, column.s3, line.s3);
    }
    const uint bits = sanitise_four(&colour);
    if (bits) atomic_add(non_finite + scale.counter, count_bits(bits, count));
    store_four(output, scale.output, x, y, x + count, colour);
  }
}
