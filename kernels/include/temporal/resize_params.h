// SPDX-License-Identifier: MIT
// Parameters of the kernels that resize a history: of all that the temporal upscaler keeps where the output has another
// size than in the previous frame.
#pragma once

#include "params.h"

#ifdef __cplusplus
namespace quincunx {
#endif

typedef struct ResizeParams {
  int width, height;                    // of the output
  int previous_width, previous_height;  // of the history
  int tiles_x, tiles_y;
  int previous_tiles_x, previous_tiles_y;
  int columns;             // in the position table, as in TemporalParams
  int columns_per_item;    // pixels that a work-item makes: a multiple of kTemporalTile
  float ratio_x, ratio_y;  // texels of the history in each pixel
  int places_x, places_y;  // of each pixel at which history is read, evenly spread over it
  float share, most;       // of a texel's confidence: the part that is left, and that at most
} ResizeParams;
QUINCUNX_CHECK_SIZE(ResizeParams, 64);

// The samples of the frame that made a history: sample i at i * spacing + start, output pixels.
typedef struct ResizeSamples {
  TexelLayout depth;
  int width, height;
  float spacing_x, spacing_y, start_x, start_y;
} ResizeSamples;
QUINCUNX_CHECK_SIZE(ResizeSamples, 32);

#ifdef __cplusplus
}  // namespace quincunx
#endif
