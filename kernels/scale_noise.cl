// SPDX-License-Identifier: MIT
// scale_noise: each output pixel takes the sample nearest to its centre, with film grain: colour times 1 + amplitude *
// n, n in [-1, 1) at random, of mean 0, one for all three colours of a pixel. Black stays black, alpha as it is.
//   params      in   extents and layouts, amplitude in [0, 1], seed: another seed gives another pattern
//   axes        in   AxisTap of each output column, then of each output row; jitter is in them
//   source      in   RGBA16F or RGBA32F, viewport of params.scale.source_width x source_height, linear, premultiplied
//   output      out  RGBA32F or RGBA16F, output extent
//   non_finite  out  non_finite[params.scale.counter] grows by the pixels whose sample is NaN or infinite
// Options: SOURCE_STORAGE, SOURCE_FORMAT, OUTPUT_FORMAT as in texel.h
// Source: Binks, "Dynamic Resolution Rendering", 2012 (noise filtering).   Reference: tests/reference/noise.cpp
#include "bits.h"
#include "resolve_params.h"
#include "texel.h"

static inline float4 grained(float4 colour, float grain) {
  return (float4)(colour.xyz * grain, colour.w);
}

__kernel void scale_noise(const NoiseParams params, __global const AxisTap* axes, COLOUR_TEXELS source,
                          OUTPUT_TEXELS output, __global uint* non_finite) {
  const ScaleParams scale = params.scale;
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(scale.columns_per_item, scale.output_width, kBlock);
  if (item.first >= item.end || y >= scale.output_height) return;

  const int row = axes[scale.row_axis + y].nearest;
  const uint row_hash = hash_of_row(y, params.seed);
  for (int x = item.first; x < item.end; x += item.step) {
    const int count = pixels_from(item, x);
    // The axis table is padded to whole blocks.
    FourPixels colour;
    colour.p0 = load_colour(source, scale.source, axes[x].nearest, row);
    if (LANES == 8) {
      colour.p1 = load_colour(source, scale.source, axes[x + 1].nearest, row);
      colour.p2 = load_colour(source, scale.source, axes[x + 2].nearest, row);
      colour.p3 = load_colour(source, scale.source, axes[x + 3].nearest, row);
    }
    const uint bits = sanitise_four(&colour);
    if (bits) atomic_add(non_finite + scale.counter, count_bits(bits, count));
    const uint4 hash = hash_of4((uint4)(0, 1, 2, 3) + ((uint)x + row_hash));
    const float4 grain = 1.0f + params.amplitude * (convert_float4(as_int4(hash)) * 0x1p-31f);
    colour.p0 = grained(colour.p0, grain.s0);
    colour.p1 = grained(colour.p1, grain.s1);
    colour.p2 = grained(colour.p2, grain.s2);
    colour.p3 = grained(colour.p3, grain.s3);
    store_four(output, scale.output, x, y, x + count, colour);
  }
}
