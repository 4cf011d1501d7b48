// SPDX-License-Identifier: MIT
// What resolve_temporal shows of what it knows, in place of the picture.
#pragma once

#include "temporal_evidence.h"

// Of eight pixels.
typedef struct View {
  float8 red, green, blue;
} View;

static inline View view_of(int view, TemporalTile tile, const Motion* motion, float8 confidence, float8 changed, float8 fraction_x,
                           float8 fraction_y) {
  const float8 part = confidence * (1.0f / MOST_CONFIDENCE);
  View shown = {part, part, part};
  if (view == kViewRejection) {
    shown.red = 1.0f - motion->trust;
    shown.green = edge_strength(motion->contrast);
    shown.blue = changed;
  } else if (view == kViewOffset) {
    shown.red = tile.rigid ? (float8)(tile.offset_x + 0.5f) : fraction_x;
    shown.green = tile.rigid ? (float8)(tile.offset_y + 0.5f) : fraction_y;
    shown.blue = (float8)(tile.rigid ? 1.0f : 0.0f);
  }
  return shown;
}

static inline void store_view(__global float* output, const TemporalParams* params, int x, int y, float4 value) {
  const int index = texel_index(params->output, x, y);
  if (params->half_output) {
    vstore_half4(value, index, (__global half*)output);
  } else {
    vstore4(value, index, output);
  }
}
