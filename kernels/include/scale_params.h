// SPDX-License-Identifier: MIT
// Structs that host and the kernels that upscale one frame share, as in params.h.
#pragma once

#include "params.h"

#ifdef __cplusplus
namespace quincunx {
#endif

typedef struct ScaleParams {
  int output_width;
  int output_height;
  int source_width;  // the viewport, in texels
  int source_height;
  TexelLayout source;
  TexelLayout output;
  int row_axis;          // index of the first row in the axis table
  int counter;           // index into non_finite
  int columns_per_item;  // pixels that a work-item makes: a multiple of kBlock
} ScaleParams;
QUINCUNX_CHECK_SIZE(ScaleParams, 44);

typedef struct NoiseParams {
  ScaleParams scale;
  unsigned seed;
  float amplitude;  // of scale_noise, in [0, 1]
  // Of scale_noise_offset, in 1/256 texels, [256, 250 * 256]: how far apart the places lie that a pixel may look at.
  int reach_x;
  int reach_y;
} NoiseParams;
QUINCUNX_CHECK_SIZE(NoiseParams, 60);

// What one output column (or row) reads of its axis through a filter of N taps: texels base to base + N - 1, which lie
// inside the viewport; in one of fewer than N, those beyond it have weight 0 and must not be read. Texels inner to
// inner + M - 1 are the M samples next to the centre, which bound the result where ringing is clamped.
typedef struct FilterSpan {
  int base;
  int inner;
} FilterSpan;
QUINCUNX_CHECK_SIZE(FilterSpan, 8);

// scale_filter makes a run of output pixels from at most this many filtered columns.
enum { kFilterColumns = 64 };

typedef struct FilterParams {
  int output_width;
  int output_height;
  int source_width;  // the viewport, in texels
  int source_height;
  TexelLayout source;
  TexelLayout output;
  int row_axis;  // index of the first row's span; the weights begin behind the last row's
  int taps_x;    // N of each column
  int taps_y;    // N of each row
  int inner_x;   // M of each column
  int inner_y;   // M of each row
  int run;       // output pixels whose columns fit into kFilterColumns; 0: the viewport is narrower than the taps
  int counter;   // index into non_finite
  int columns_per_item;
} FilterParams;
QUINCUNX_CHECK_SIZE(FilterParams, 64);

#ifdef __cplusplus
}  // namespace quincunx
#endif
