// SPDX-License-Identifier: MIT
// The second layer of history. Host and kernels share these structs.
//
// Where two surfaces at different depths that move differently meet, a texel has two histories: of the *far* layer,
// whose place is that of the one history elsewhere, and of the *near* layer, which follows the near surface's motion.
// The near layer's *coverage* is the part of the texel that its surface hides, however transparent it is; its colour
// and alpha are multiplied by that. The picture is near + (1 - coverage) far. (docs/layers.md)
#pragma once

#include "temporal/tile.h"

#ifdef __cplusplus
namespace quincunx {
#endif

// A sample of a near surface next to a farther one that moves differently. It lives on for some frames if what it
// shows is thin: a wire keeps its motion in a frame whose samples all missed it. Lengths are output pixels.
typedef struct LayerRecord {
  float x, y;                // its place
  float depth;               // reversed
  float motion_x, motion_y;  // added to its place they give its place in the previous frame
  float drift_x, drift_y;    // what motion grows by from frame to frame
  int is_thin;               // 0 or 1
} LayerRecord;
QUINCUNX_CHECK_SIZE(LayerRecord, 32);

// The two layers at a sample that has two; at others anything.
typedef struct LayerSplit {
  float near_depth, far_depth;  // reversed
  float motion_x, motion_y;     // the near layer's, output pixels, as that of a record
} LayerSplit;
QUINCUNX_CHECK_SIZE(LayerSplit, 16);

#ifndef __cplusplus
// A sample has two layers if the motion edge in its Reprojection is -0, which is never one.
#define SPLIT_MOTION_EDGE_BITS ((int)0x80000000)

static inline bool marks_split(float motion_edge) {
  return as_int(motion_edge) == SPLIT_MOTION_EDGE_BITS;
}
#endif

// Returns a depth half-way between the layers.
static inline float between_of(LayerSplit split) {
  return 0.5f * (split.near_depth + split.far_depth);
}

// The near layer of a tile, whose TileReprojection is the far layer's.
typedef struct LayerTile {
  float phase_x, phase_y;  // offset of the near layer's texels; 0 if it is not rigid
  float between;           // mean of the depths half-way between the layers of its samples
  float motion_range;      // how far the near layers of its samples move apart: on the larger axis, output pixels
  int is_rigid;            // 0 or 1: the near layer
  int is_split;            // 0 or 1: a sample in it or next to it has two layers
  int is_layered;          // 0 or 1: split, or texels of two layers may be where it was
} LayerTile;
QUINCUNX_CHECK_SIZE(LayerTile, 28);

typedef struct LayerParams {
  int width, height;                    // size of this frame's viewport, in samples
  int previous_width, previous_height;  // size of the previous one
  TexelLayout velocity;
  TexelLayout depth;
  TexelLayout reprojection;
  // The centre of sample (i, j) in output pixels: (i * spacing_x + start_x, j * spacing_y + start_y).
  float spacing_x, spacing_y, start_x, start_y;
  float previous_spacing_x, previous_spacing_y, previous_start_x, previous_start_y;
  float motion_x, motion_y;            // from velocity to motion in output pixels
  float to_previous_x, to_previous_y;  // from output pixels to pixels of the previous viewport
  int tiles_x, tiles_y;
  int columns_per_item;
} LayerParams;
QUINCUNX_CHECK_SIZE(LayerParams, 16 + 24 + 48 + 12);

// The samples of the last frame that a history holds.
typedef struct HistorySamples {
  TexelLayout depth;
  int width, height;                             // size of its viewport
  float spacing_x, spacing_y, start_x, start_y;  // sample i lies at (i * spacing + start), output pixels
} HistorySamples;
QUINCUNX_CHECK_SIZE(HistorySamples, 32);

#ifdef __cplusplus
}  // namespace quincunx
#endif
