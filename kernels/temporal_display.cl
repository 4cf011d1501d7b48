// SPDX-License-Identifier: MIT
// temporal_display: the picture of a history: at the pixels' centres, and smoothed where little is known.
//   A pixel of confidence W counts W + .02 and its eight neighbours .3 exp(-2 W) each. It is not fed back.
//
//   params     in   extents, layouts
//   positions  in   ALPHA 1: of each output column, then row, in the viewport, as in resolve_reprojected
//   colour     in   ALPHA 1: RGBA16F or RGBA32F, viewport: alpha is bilinear's of this frame
//   tiles      in   TemporalTile of each tile
//   history    in   of this frame
//   output     out  RGBA32F or RGBA16F, output extent
// Options: ALPHA   1 (default) | 0: the picture is opaque
//          SMOOTH  1 (default) | 0
//          SOURCE_STORAGE, SOURCE_FORMAT, OUTPUT_FORMAT as in texel.h, HISTORY_FORMAT as in history.h
// Reference: tests/reference/temporal_display.cpp
#include "texel.h"

#include "distance_weights.h"
#include "frame_samples.h"
#include "history_sampling.h"

#ifndef ALPHA
#define ALPHA 1
#endif
#ifndef SMOOTH
#define SMOOTH 1
#endif
#if ALPHA < 0 || ALPHA > 1
#error "ALPHA must be 0 or 1"
#endif
#if SMOOTH < 0 || SMOOTH > 1
#error "SMOOTH must be 0 or 1"
#endif

#define DISPLAY_SHARPNESS -0.75f  // a of the cubic
#define LITTLE 1.5f               // from here on smoothing would not be seen
#define NEIGHBOUR_WEIGHT 0.3f
#define CENTRE_WEIGHT 0.02f

// Of a tile: the texel before the centres of its pixels, and the weights of the four on each axis.
typedef struct Display {
  int step_x, step_y;
  float4 wx, wy;
  bool apart;  // the texels' pictures do not lie at their centres
} Display;

static inline Display display_of(TemporalTile tile) {
  Display display;
  display.apart = tile.offset_x != 0.0f || tile.offset_y != 0.0f;
  display.step_x = 1 + (tile.offset_x > 0.0f);
  display.step_y = 1 + (tile.offset_y > 0.0f);
  const Cubic x = cubic_weights((float8)((float)(display.step_x - 1) - tile.offset_x), DISPLAY_SHARPNESS);
  const Cubic y = cubic_weights((float8)((float)(display.step_y - 1) - tile.offset_y), DISPLAY_SHARPNESS);
  display.wx = (float4)(x.w0.s0, x.w1.s0, x.w2.s0, x.w3.s0);
  display.wy = (float4)(y.w0.s0, y.w1.s0, y.w2.s0, y.w3.s0);
  return display;
}

static inline float4 smooth_little_known(HISTORY_TEXELS history, const TemporalDisplayParams* params, int x, int y, float4 centre,
                                         float confidence) {
  const float other = NEIGHBOUR_WEIGHT * bell(2.0f * confidence);
  float4 sum = centre * (confidence + CENTRE_WEIGHT);
  for (int i = 0; i < 9; ++i) {
    if (i == 4) continue;
    const int column = clamp(x + i % 3 - 1, 0, params->output_width - 1), row = clamp(y + i / 3 - 1, 0, params->output_height - 1);
    sum += other * load_history(history, row * params->output_width + column);
  }
  return sum / (confidence + CENTRE_WEIGHT + 8.0f * other);
}

#if ALPHA
static inline Positions position_at(__global const int* positions, int texel, int fraction, int last) {
  const Positions at = {(int8)(positions[texel]), (float8)(as_float(positions[fraction]))};
  return moved_positions(at, (float8)(0.0f), last);
}

static inline float alpha_at(const TemporalDisplayParams* params, COLOUR_TEXELS colour, Positions row, Positions column) {
  const SourceFrame frame = params->frame0;
  const int x = column.texel.s0, y = row.texel.s0;
  const int right = min(x + 1, frame.width - 1), below = min(y + 1, frame.height - 1);
  const float4 alphas = sanitise4((float4)(
      load_colour(colour, frame.colour, x, y).w, load_colour(colour, frame.colour, right, y).w,
      load_colour(colour, frame.colour, x, below).w, load_colour(colour, frame.colour, right, below).w));
  const float2 between = alphas.xz + (alphas.yw - alphas.xz) * column.fraction.s0;
  return between.x + (between.y - between.x) * row.fraction.s0;
}
#endif

__kernel void temporal_display(const TemporalDisplayParams params, __global const int* positions, COLOUR_TEXELS colour,
                               __global const TemporalTile* tiles, HISTORY_TEXELS history, OUTPUT_TEXELS output) {
  const int y = get_global_id(1);
  const int first = get_global_id(0) * params.columns_per_item;
  if (first >= params.output_width || y >= params.output_height) return;

  const int width = params.output_width, height = params.output_height;
  const int end = min(first + params.columns_per_item, width);
#if ALPHA
  const int rows = 2 * params.columns;
  const Positions row = position_at(positions, rows + y, rows + height + y, params.frame0.height - 1);
#endif
  for (int start = first; start < end; start += kTemporalTile) {
    const Display display = display_of(tiles[y / kTemporalTile * params.tiles_x + start / kTemporalTile]);
    const int y0 = y - display.step_y;
    for (int x = start; x < min(start + kTemporalTile, end); ++x) {
      float4 pixel = load_history(history, y * width + x);
#if SMOOTH
      const float confidence = pixel.w;
#endif
      const int x0 = x - display.step_x;
      if (display.apart) {
        const bool inside = x0 >= 0 && y0 >= 0 && x0 + 4 <= width && y0 + 4 <= height;
        pixel = sample_history(history, width, height, x0, y0, inside, display.wx, display.wy);
      }
#if SMOOTH
      if (confidence < LITTLE) pixel = smooth_little_known(history, &params, x, y, pixel, confidence);
#endif
#if ALPHA
      const Positions column = position_at(positions, x, params.columns + x, params.frame0.width - 1);
      const float alpha = alpha_at(&params, colour, row, column);
#else
      const float alpha = 1.0f;
#endif
      store_output(output, params.output, x, y, (float4)(pixel.xyz, alpha));
    }
  }
}
