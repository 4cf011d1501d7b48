// SPDX-License-Identifier: MIT
// Depth dilated: of each sample the largest, the nearest, of its 3x3 within the viewport. A NaN does not count.
#pragma once

#include "texel_blocks.h"

// The depths of columns x - 2 to x + 5, clamped to the edge.
static inline float8 load_depth_columns(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width) {
#if SOURCE_STORAGE == BUFFER
  if (x >= 2 && x + 5 < width) return vload8(0, texels + texel_index(layout, x - 2, y));
#endif
  return (float8)(load_depth4(texels, layout, block_columns(x - 2, width), y),
                  load_depth4(texels, layout, block_columns(x + 2, width), y));
}

// The dilated depths of four samples of a row, x to x + 3, and of those left and right of each.
typedef struct DilatedDepths {
  float4 left, own, right;
} DilatedDepths;

static inline DilatedDepths load_dilated_depths(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width,
                                                int height) {
  const float8 above = load_depth_columns(texels, layout, x, max(y - 1, 0), width);
  const float8 row = load_depth_columns(texels, layout, x, y, width);
  const float8 below = load_depth_columns(texels, layout, x, min(y + 1, height - 1), width);
  const float8 most = fmax(fmax(above, row), below);
  const DilatedDepths depths = {fmax(fmax(most.s0123, most.s1234), most.s2345),
                                fmax(fmax(most.s1234, most.s2345), most.s3456),
                                fmax(fmax(most.s2345, most.s3456), most.s4567)};
  return depths;
}

// That of one sample; that of the sample alone where it is more than `limit`, which says enough.
static inline float load_dilated_depth(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width, int height,
                                       float limit) {
  float most = load_depth(texels, layout, x, y);
  for (int j = max(y - 1, 0); j <= min(y + 1, height - 1) && !(most > limit); ++j) {
    for (int i = max(x - 1, 0); i <= min(x + 1, width - 1); ++i) most = fmax(most, load_depth(texels, layout, i, j));
  }
  return most;
}
