// SPDX-License-Identifier: MIT
// Bilinear sampling with axis tables. scale_bilinear and resolve_quincunx share it, so that a resolve without history
// gives the same bits.
#pragma once

#include "sanitise.h"
#include "texel.h"

// The two texels of one row, as float8; a viewport one texel wide has only one.
static inline float8 load_taps(COLOUR_TEXELS texels, TexelLayout layout, int width, int x, int y) {
  if (width < 2) {
    const float4 only = load_colour(texels, layout, x, y);
    return (float8)(only, only);
  }
  return load_colour_pair(texels, layout, x, y);
}

static inline float4 weigh_taps(float8 upper, float8 lower, AxisTap column, AxisTap row) {
  const float8 pair = upper * row.weight0 + lower * row.weight1;
  return pair.lo * column.weight0 + pair.hi * column.weight1;
}

// Sets *non_finite when a tap of non-zero weight is NaN or infinite; those count as 0 and +-65504.
static inline float4 sample_bilinear(COLOUR_TEXELS texels, TexelLayout layout, int width, int height, AxisTap column,
                              AxisTap row, bool* non_finite) {
  const int below = row.base + (height > 1 ? 1 : 0);
  const float8 upper = load_taps(texels, layout, width, column.base, row.base);
  const float8 lower = load_taps(texels, layout, width, column.base, below);
  float4 mean = weigh_taps(upper, lower, column, row);
  // NaN and Inf pass through any weight (0 * Inf is NaN), so one test of the mean covers all four taps.
  *non_finite = false;
  if (any_non_finite4(mean)) {
    const bool left = column.weight0 != 0.0f;
    const bool right = column.weight1 != 0.0f;
    *non_finite = (row.weight0 != 0.0f && ((left && any_non_finite4(upper.lo)) || (right && any_non_finite4(upper.hi)))) ||
                  (row.weight1 != 0.0f && ((left && any_non_finite4(lower.lo)) || (right && any_non_finite4(lower.hi))));
    mean = weigh_taps((float8)(sanitise4(upper.lo), sanitise4(upper.hi)),
                      (float8)(sanitise4(lower.lo), sanitise4(lower.hi)), column, row);
  }
  return mean;
}
