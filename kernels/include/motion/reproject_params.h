// SPDX-License-Identifier: MIT
// Structs that host and reproject share, as in params.h.
#pragma once

#include "params.h"

#ifdef __cplusplus
namespace quincunx {
#endif

// Of one sample of this frame: the surface that it shows was at the sample's own place + (x, y) in the previous frame.
// Written by reproject.
typedef struct Reprojection {
  float x, y;   // pixels of the previous frame's viewport, within +-65504
  float trust;  // in [0, 1]: of what the previous frame holds there; NaN: the sample's velocity or depth is not finite
  // The motion edge at the sample: the largest difference of velocity to its eight neighbours, output pixels a frame.
  // If that of the previous frame at the place above was larger, it stands here as a negative number. 0 without
  // MOTION_EDGE.
  float motion_edge;
} Reprojection;
QUINCUNX_CHECK_SIZE(Reprojection, 16);

typedef struct ReprojectParams {
  int width;  // the viewport of this frame
  int height;
  int previous_width;
  int previous_height;
  TexelLayout velocity0;
  TexelLayout velocity1;
  TexelLayout depth0;
  TexelLayout depth1;
  TexelLayout reactive0;
  TexelLayout reactive1;
  TexelLayout reprojection;
  TexelLayout previous_reprojection;
  int columns_per_item;  // pixels that a work-item makes: a multiple of kBlock
  // The texel coordinate (0 at the first sample, 1 at the next) in the previous frame of sample (i, j), if it stands
  // still: (i * step_x + start_x, j * step_y + start_y).
  float step_x, step_y, start_x, start_y;
  float motion_x, motion_y;  // from velocity0 to pixels of the previous frame, backwards in time
  float edge_x, edge_y;  // the left and the upper edge of the previous frame, as texel coordinates
  // From the units of the velocity source to sqrt(K) render pixels, per frame.
  float speed0_x, speed0_y;
  float speed1_x, speed1_y;
  float motion_edge_x, motion_edge_y;  // from velocity0 to output pixels
  // The distance, over that in this frame, that what sample (i, j) shows had in the previous frame if it stands still
  // and has the depth d: i * distance_x + j * distance_y + d * distance_depth + distance_start.
  float distance_x, distance_y, distance_depth, distance_start;
} ReprojectParams;
QUINCUNX_CHECK_SIZE(ReprojectParams, 16 + 64 + 4 + 72);

#ifdef __cplusplus
}  // namespace quincunx
#endif
