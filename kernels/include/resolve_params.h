// SPDX-License-Identifier: MIT
// Structs that host and the kernels that upscale one frame, resolve two, or fill a checkerboard share, as in params.h.
#pragma once

#include "motion/velocity_params.h"
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
  float amplitude;  // strength of scale_noise's grain, in [0, 1]
  // Reach of scale_noise_offset, in 1/256 texels, [256, 250 * 256]: how far apart a pixel's possible places lie.
  int reach_x;
  int reach_y;
} NoiseParams;
QUINCUNX_CHECK_SIZE(NoiseParams, 60);

// Taps of one output column (or row) on its axis, for a filter of N taps: texels base to base + N - 1, which lie inside
// the viewport; in one of fewer than N, those beyond it have weight 0 and must not be read. Texels inner to
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

// ---- Two frames.
enum { kReprojectedBlock = 8 };  // as many as a CPU has lanes (lanes.h): tables are padded to that

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
  int columns_per_item;  // pixels that a work-item makes, at least
  float falloff0_x, falloff0_y;  // 1 / r^2 of each axis, per frame
  float falloff1_x, falloff1_y;
} ReprojectedParams;
QUINCUNX_CHECK_SIZE(ReprojectedParams, 8 + 2 * 32 + 16 + 12 + 16);

// ---- Checkerboard.
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
