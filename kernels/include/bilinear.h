// SPDX-License-Identifier: MIT
// Bilinear sampling with axis tables, four output pixels of one row at a time. scale_bilinear and resolve_quincunx
// share it, so that a resolve without history gives the same bits.
#pragma once

#include "bits.h"
#include "texel.h"

static inline float4 weigh_taps(float8 upper, float8 lower, AxisTap column, AxisTap row) {
  const float8 pair = upper * row.weight0 + lower * row.weight1;
  return pair.lo * column.weight0 + pair.hi * column.weight1;
}

// The slow path, for any viewport and any values: NaN counts as 0, +-Inf as +-65504. Sets *non_finite when a tap of
// non-zero weight is either.
static inline float4 sample_careful(COLOUR_TEXELS texels, TexelLayout layout, int width, int height, AxisTap column,
                                    AxisTap row, bool* non_finite) {
  const int right = min(column.base + 1, width - 1);
  const int below = min(row.base + 1, height - 1);
  const float4 upper0 = load_colour(texels, layout, column.base, row.base);
  const float4 upper1 = load_colour(texels, layout, right, row.base);
  const float4 lower0 = load_colour(texels, layout, column.base, below);
  const float4 lower1 = load_colour(texels, layout, right, below);
  const bool upper_met = (column.weight0 != 0.0f && any_non_finite4(upper0)) ||
                         (column.weight1 != 0.0f && any_non_finite4(upper1));
  const bool lower_met = (column.weight0 != 0.0f && any_non_finite4(lower0)) ||
                         (column.weight1 != 0.0f && any_non_finite4(lower1));
  *non_finite = (row.weight0 != 0.0f && upper_met) || (row.weight1 != 0.0f && lower_met);
  return weigh_taps((float8)(sanitise4(upper0), sanitise4(upper1)), (float8)(sanitise4(lower0), sanitise4(lower1)),
                    column, row);
}

// The fast way: a viewport at least two texels wide, all taps finite. NaN and Inf pass through any weight, 0 * Inf
// being NaN: all taps are finite if the mean is.
static inline float4 sample_finite(COLOUR_TEXELS texels, COLOUR_ROW upper, COLOUR_ROW lower, AxisTap column,
                                   AxisTap row) {
  return weigh_taps(load_colour_pair(texels, upper, column.base), load_colour_pair(texels, lower, column.base), column,
                    row);
}

// Into *mean the pixels whose columns start at `columns`. `careful`, a constant, chooses the way; the slow one sets bit
// i of *non_finite where pixel i met NaN or Inf.
__attribute__((always_inline)) static inline void sample_four(bool careful, COLOUR_TEXELS texels,
                                                                    TexelLayout layout, int width, int height,
                                                                    __global const AxisTap* columns,
                                                                    AxisTap row, FourPixels* mean, uint* non_finite) {
  if (careful) {
    bool met0, met1, met2, met3;
    mean->p0 = sample_careful(texels, layout, width, height, columns[0], row, &met0);
    *non_finite = (uint)met0;
    if (LANES == 1) return;
    mean->p1 = sample_careful(texels, layout, width, height, columns[1], row, &met1);
    mean->p2 = sample_careful(texels, layout, width, height, columns[2], row, &met2);
    mean->p3 = sample_careful(texels, layout, width, height, columns[3], row, &met3);
    *non_finite |= (uint)met1 << 1 | (uint)met2 << 2 | (uint)met3 << 3;
  } else {
    COLOUR_ROW upper = colour_row(texels, layout, row.base);
    COLOUR_ROW lower = colour_row(texels, layout, min(row.base + 1, height - 1));
    mean->p0 = sample_finite(texels, upper, lower, columns[0], row);
    if (LANES == 1) return;
    mean->p1 = sample_finite(texels, upper, lower, columns[1], row);
    mean->p2 = sample_finite(texels, upper, lower, columns[2], row);
    mean->p3 = sample_finite(texels, upper, lower, columns[3], row);
  }
}
