// SPDX-License-Identifier: MIT
// Structs that host and the kernels that resolve two frames share, as in params.h.
#pragma once

#include "params.h"

#ifdef __cplusplus
namespace quincunx {
#endif

enum { kReprojectedBlock = 8 };  // pixels that resolve_reprojected, whose weights are many, makes at once

typedef struct ResolveParams {
  int output_width;
  int output_height;
  SourceFrame frame0;  // this frame
  SourceFrame frame1;  // the previous one
  TexelLayout output;
  int row_axis;          // index of the first row in the axis tables
  int counter;           // index into non_finite
  int columns_per_item;  // pixels that a work-item makes: a multiple of kBlock
  // From the units of the velocity source to sqrt(K) render pixels, per frame.
  float velocity0_scale_x, velocity0_scale_y;
  float velocity1_scale_x, velocity1_scale_y;
} ResolveParams;
QUINCUNX_CHECK_SIZE(ResolveParams, 8 + 2 * 32 + 8 + 12 + 16);

typedef struct ReprojectedParams {
  int output_width;
  int output_height;
  SourceFrame frame0;  // this frame
  SourceFrame frame1;  // the previous one
  TexelLayout reprojection;
  TexelLayout output;
  int columns;           // in the position tables: texels of the columns, then fractions; then the same of the rows
  int counter;           // index into non_finite
  int columns_per_item;  // pixels that a work-item makes: a multiple of kReprojectedBlock
  float falloff0_x, falloff0_y;  // 1 / r^2 of each axis, per frame
  float falloff1_x, falloff1_y;
} ReprojectedParams;
QUINCUNX_CHECK_SIZE(ReprojectedParams, 8 + 2 * 32 + 16 + 12 + 16);

#ifdef __cplusplus
}  // namespace quincunx
#endif
