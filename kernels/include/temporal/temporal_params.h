// SPDX-License-Identifier: MIT
// Parameters of the temporal upscaler's kernels, which host and kernels share, as in params.h.
#pragma once

#include "params.h"
#include "temporal/tile.h"

#ifdef __cplusplus
namespace quincunx {
#endif

typedef struct TemporalTileParams {
  SourceFrame frame;
  int output_width;
  int output_height;
  int tiles_x;
  int tiles_y;
  TexelLayout reprojection;
  // The centre of sample (i, j) in output pixels: (i * spacing_x + start_x, j * spacing_y + start_y).
  float spacing_x, spacing_y;
  float start_x, start_y;
  float motion_x, motion_y;  // from Reprojection's pixels of the previous viewport to output pixels
  int parity;                // as in TemporalParams
} TemporalTileParams;
QUINCUNX_CHECK_SIZE(TemporalTileParams, 32 + 16 + 8 + 28);

typedef struct TemporalParams {
  int output_width;
  int output_height;
  SourceFrame frame0;  // this frame
  SourceFrame frame1;  // the previous one: only the viewport and reactive
  TexelLayout reprojection;
  TexelLayout output;          // layout of a debug view
  int columns;                 // in the position table, as in ReprojectedParams
  int counter;                 // index into non_finite
  int columns_per_item;        // pixels that a work-item makes, at least
  float motion_x, motion_y;    // from Reprojection's pixels of the previous viewport to output pixels
  float spacing_x, spacing_y;  // output pixels between neighbouring samples
  int tiles_x;
  int tiles_y;
  int parity;  // on a checkerboard sample (x, y) is shaded where (x + y) % 2 is this; -1: all are
} TemporalParams;
QUINCUNX_CHECK_SIZE(TemporalParams, 8 + 2 * 32 + 16 + 12 + 12 + 16);

typedef struct TemporalDisplayParams {
  int output_width;
  int output_height;
  TexelLayout output;
  int tiles_x;
  int columns_per_item;  // pixels that a work-item makes, at least
  int first;             // 1: no frame came before
} TemporalDisplayParams;
QUINCUNX_CHECK_SIZE(TemporalDisplayParams, 8 + 8 + 12);

typedef struct MergeParams {
  int width;  // extent of the picture
  int height;
  TexelLayout centred;
  int columns_per_item;  // pixels that a work-item makes
  float other_exposure;  // the factor of the other history's light; 0: there is none
} MergeParams;
QUINCUNX_CHECK_SIZE(MergeParams, 8 + 8 + 8);

// Parameters of the kernels that resize what is kept where the output has another size than in the previous frame.
typedef struct ResizeParams {
  int width, height;                    // size of the output
  int previous_width, previous_height;  // size of the history
  int tiles_x, tiles_y;
  int previous_tiles_x, previous_tiles_y;
  int columns;             // in the position table, as in TemporalParams
  int columns_per_item;    // pixels that a work-item makes, at least
  float ratio_x, ratio_y;  // texels of the history in each pixel
  int places_x, places_y;  // number of places in each pixel at which history is read, evenly spread over it
  float share, most;       // part of a texel's confidence that is left, and the most
} ResizeParams;
QUINCUNX_CHECK_SIZE(ResizeParams, 64);

enum { kRefineBlock = 8 };  // rows that a work-item makes at a time, and pixels of them in temporal_denoise

typedef struct RefineParams {
  int width;  // extent of the picture
  int height;
  TexelLayout source;
  TexelLayout output;
} RefineParams;
QUINCUNX_CHECK_SIZE(RefineParams, 8 + 2 * 8);

#ifdef __cplusplus
}  // namespace quincunx
#endif
