// SPDX-License-Identifier: MIT
// Reactive values as reproject reads them. With MOTION_EDGE, for an accumulated history: the largest of 3x3, since such
// a picture holds each sample further than its own pixel (+.35 dB on particles), and of 5x5 in the previous frame,
// whose pixels lie between other samples (the trail behind a transparent falls from 7/255 to 0). Without it the
// sample's own.
#pragma once

#include "motion/reproject_params.h"
#include "texel_blocks.h"

#if MOTION_EDGE
static inline float4 reactive_at(const ReprojectParams* params, REACTIVE_TEXELS texels, int x, int y) {
  float4 largest = (float4)(0.0f);
  for (int row = max(y - 1, 0); row <= min(y + 1, params->height - 1); ++row) {
    for (int column = x - 1; column <= x + 1; ++column)
      largest = max(largest, load_reactive_block(texels, params->reactive0, column, row, params->width));
  }
  return largest;
}

static inline float4 previous_reactive_at(const ReprojectParams* params, REACTIVE_TEXELS texels, int4 x, int4 y) {
  float4 largest = (float4)(0.0f);
  for (int i = 0; i < 25; ++i) {
    const int4 column = clamp(x + (i % 5 - 2), (int4)(0), (int4)(params->previous_width - 1));
    const int4 row = clamp(y + (i / 5 - 2), (int4)(0), (int4)(params->previous_height - 1));
    largest = max(largest, load_reactive_at(texels, params->reactive1, column, row));
  }
  return largest;
}
#else
static inline float4 reactive_at(const ReprojectParams* params, REACTIVE_TEXELS texels, int x, int y) {
  return load_reactive_block(texels, params->reactive0, x, y, params->width);
}

static inline float4 previous_reactive_at(const ReprojectParams* params, REACTIVE_TEXELS texels, int4 x, int4 y) {
  return load_reactive_at(texels, params->reactive1, x, y);
}
#endif
