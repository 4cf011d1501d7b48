// SPDX-License-Identifier: MIT
// Structs that host and the kernels of the motion blur share, as in params.h.
#pragma once

#include "params.h"

#ifdef __cplusplus
namespace quincunx {
#endif

// The motion blur looks at the output in tiles, and measures streaks in fixed point.
enum {
  kTileSide = 32,        // output pixels
  kStreakUnits = 64,     // in an output pixel
  kLongestStreak = 8 * kTileSide * kStreakUnits,  // on either axis; longer ones are cut
};

// The streaks of the surfaces seen in a tile: the longest one and the range of each axis.
typedef struct TileStreaks {
  int longest_x;
  int longest_y;
  int least_x;
  int least_y;
  int most_x;
  int most_y;
} TileStreaks;
QUINCUNX_CHECK_SIZE(TileStreaks, 24);

// How the pixels of a tile are blurred.
enum {
  kTileCopy = 0,     // nothing that reaches it moves by half a pixel
  kTileUniform = 1,  // all that reaches it moves alike: colour alone is read
  kTileMixed = 2,    // depth and velocity decide for each sample
};

typedef struct TileBlur {
  int kind;
  int samples_log2;
  int x;  // the longest streak that reaches the tile
  int y;
} TileBlur;
QUINCUNX_CHECK_SIZE(TileBlur, 16);

typedef struct MotionParams {
  int output_width;
  int output_height;
  int tiles_x;
  int tiles_y;
  TexelLayout source;    // the resolved picture
  TexelLayout velocity;
  TexelLayout depth;
  TexelLayout output;
  int row_axis;          // index of the first row in the axis table
  int columns_per_item;  // pixels that a work-item makes, at least
  int most_samples_log2;
  float scale_x, scale_y;  // from the velocity target's units to streaks
} MotionParams;
QUINCUNX_CHECK_SIZE(MotionParams, 68);

#ifdef __cplusplus
}  // namespace quincunx
#endif
