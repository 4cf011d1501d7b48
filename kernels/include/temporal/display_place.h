// SPDX-License-Identifier: MIT
// How a history's pixels are shown at their centres.
#pragma once

#include "temporal/history_sampling.h"

#define DISPLAY_SHARPNESS -0.75f  // the cubic's a: found by search on the development scenes

// How the pixels of a tile are resampled: which texel is the first of the four around the centre of each, and their
// weights on each axis.
typedef struct Display {
  int step_x, step_y;  // the first of the four lies so many texels before the pixel's own
  float4 wx, wy;
  bool has_phase;  // false: nothing needs to be resampled
} Display;

static inline Display display_of(float phase_x, float phase_y) {
  Display display;
  display.has_phase = phase_x != 0.0f || phase_y != 0.0f;
  display.step_x = 1 + (phase_x > 0.0f);
  display.step_y = 1 + (phase_y > 0.0f);
  const Cubic x = cubic_weights((float8)((float)(display.step_x - 1) - phase_x), DISPLAY_SHARPNESS);
  const Cubic y = cubic_weights((float8)((float)(display.step_y - 1) - phase_y), DISPLAY_SHARPNESS);
  display.wx = (float4)(x.w0.s0, x.w1.s0, x.w2.s0, x.w3.s0);
  display.wy = (float4)(y.w0.s0, y.w1.s0, y.w2.s0, y.w3.s0);
  return display;
}
