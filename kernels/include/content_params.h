// SPDX-License-Identifier: MIT
// Structs that host and measure_content share, as in params.h.
#pragma once

#include "params.h"

#ifdef __cplusplus
namespace quincunx {
#endif

// A tile of the picture is about kContentTile^2 output pixels, of which kContentSamples^2 are asked what they show.
enum { kContentTile = 32, kContentSamples = 8 };

// Numbers of samples, over the whole picture; `speed` in 1/16 output pixels, summed over the moving ones.
typedef struct ContentSums {
  unsigned moving;
  unsigned speed;
  unsigned apart;
  unsigned thin;
  unsigned light;
  unsigned zoom;
} ContentSums;
QUINCUNX_CHECK_SIZE(ContentSums, 24);

typedef struct ContentParams {
  int width;  // the viewport, in texels
  int height;
  int tiles_x;
  int tiles_y;
  TexelLayout velocity;
  TexelLayout depth;
  TexelLayout reactive;
  int reach_x;  // texels to either side of what is thin
  int reach_y;
  float pixels_x;  // of velocity, in output pixels
  float pixels_y;
  float step_x;  // output pixels between two samples
  float step_y;
} ContentParams;
QUINCUNX_CHECK_SIZE(ContentParams, 64);

#ifdef __cplusplus
}  // namespace quincunx
#endif
