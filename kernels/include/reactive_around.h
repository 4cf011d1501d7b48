// SPDX-License-Identifier: MIT
// Reactive values as reproject reads them. Option: CONTRAST 1: the largest of 3x3, since an accumulated picture holds each
// sample further than its own pixel, and of 5x5 in the previous frame, whose pixels lie between other samples; 0: the sample's own.
#pragma once

#include "texel_blocks.h"

#if CONTRAST
static inline float4 reactive_block(const ReprojectParams* params, REACTIVE_TEXELS texels, int x, int y) {
  float4 largest = (float4)(0.0f);
  for (int row = max(y - 1, 0); row <= min(y + 1, params->height - 1); ++row) {
    for (int column = x - 1; column <= x + 1; ++column)
      largest = max(largest, load_reactive_block(texels, params->reactive0, column, row, params->width));
  }
  return largest;
}

static inline float4 previous_reactive(const ReprojectParams* params, REACTIVE_TEXELS texels, int4 x, int4 y) {
  float4 largest = (float4)(0.0f);
  for (int i = 0; i < 25; ++i) {
    const int4 column = clamp(x + (i % 5 - 2), (int4)(0), (int4)(params->previous_width - 1));
    const int4 row = clamp(y + (i / 5 - 2), (int4)(0), (int4)(params->previous_height - 1));
    largest = max(largest, load_reactive_at(texels, params->reactive1, column, row));
  }
  return largest;
}
#else
static inline float4 reactive_block(const ReprojectParams* params, REACTIVE_TEXELS texels, int x, int y) {
  return load_reactive_block(texels, params->reactive0, x, y, params->width);
}

static inline float4 previous_reactive(const ReprojectParams* params, REACTIVE_TEXELS texels, int4 x, int4 y) {
  return load_reactive_at(texels, params->reactive1, x, y);
}
#endif
