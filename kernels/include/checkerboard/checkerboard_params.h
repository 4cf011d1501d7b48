// SPDX-License-Identifier: MIT
// The struct that host and resolve_checkerboard share, as in params.h.
#pragma once

#include "motion/velocity_params.h"
#include "params.h"

#ifdef __cplusplus
namespace quincunx {
#endif

// A work-item makes runs of this many neighbouring pixels of a row, half of which are filled.
enum { kCheckerboardBlock = 16 };

// The targets of one frame.
typedef struct FrameTexels {
  TexelLayout colour, velocity, depth, reactive;
} FrameTexels;
QUINCUNX_CHECK_SIZE(FrameTexels, 32);

typedef struct CheckerboardParams {
  int width;  // the viewport of this frame
  int height;
  int previous_width;
  int previous_height;
  int parity;  // pixel (x, y) is shaded where (x + y) % 2 is this
  int has_history;
  int columns_per_item;  // a multiple of kCheckerboardBlock
  FrameTexels shaded, filled;
  TexelLayout previous_colour, previous_depth;
  // The texel coordinate (0 at the first sample, 1 at the next) in the previous frame of sample (i, j), if it stands
  // still: (i * step_x + start_x, j * step_y + start_y).
  float step_x, step_y, start_x, start_y;
  float motion_x, motion_y;  // from velocity to pixels of the previous frame, backwards in time
  float edge_x, edge_y;      // the left and the upper edge of the previous frame, as texel coordinates
  CameraVelocity camera;     // MOTION CAMERA
} CheckerboardParams;
QUINCUNX_CHECK_SIZE(CheckerboardParams, 28 + 2 * 32 + 16 + 32 + 80);

#ifdef __cplusplus
}  // namespace quincunx
#endif
