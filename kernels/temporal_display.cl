// SPDX-License-Identifier: MIT
// temporal_display: the picture of a history: at the pixels' centres, and smoothed where little is known.
//   A pixel of confidence W counts W + .02 and its eight neighbours .3 exp(-2 W) each. It is not fed back.
//   A first frame is not smoothed: it would lose what it has of fine texture.
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

// What history holds of eight pixels, and what is shown of it.
typedef struct Pixels {
  EightTexels own, shown;
} Pixels;

// Of the tile's pixels from (x, y) on, anywhere; beyond the edge the outermost once more.
static inline Pixels gather_pixels(HISTORY_TEXELS history, const TemporalDisplayParams* params, const Display* display, int x, int y) {
  const int width = params->output_width, height = params->output_height;
  float4 own[8], shown[8];
  for (int i = 0; i < 8; ++i) {
    const int column = min(x + i, width - 1);
    own[i] = load_history(history, y * width + column);
    shown[i] = own[i];
    if (display->apart)
      shown[i] = sample_history(history, width, height, column - display->step_x, y - display->step_y, false, display->wx, display->wy);
  }
  const Pixels pixels = {{vload16(0, (const float*)own), vload16(1, (const float*)own)},
                         {vload16(0, (const float*)shown), vload16(1, (const float*)shown)}};
  return pixels;
}

// The same where all texels that it needs are inside.
static inline Pixels load_pixels(HISTORY_TEXELS history, int width, const Display* display, int x, int y) {
  const int index = y * width + x;
  const EightTexels own = load_history8(history, index);
  Pixels pixels = {own, own};
  if (display->apart)
    pixels.shown = sample_history_row(history, width, x - display->step_x, y - display->step_y, display->wx, display->wy);
  return pixels;
}

#if SMOOTH
// The sums of each pixel's eight neighbours.
static inline EightTexels gather_around(HISTORY_TEXELS history, const TemporalDisplayParams* params, int x, int y) {
  float4 sums[8];
  for (int i = 0; i < 8; ++i) {
    sums[i] = (float4)(0.0f);
    for (int j = 0; j < 9; ++j) {
      const int column = clamp(x + i + j % 3 - 1, 0, params->output_width - 1);
      const int row = clamp(y + j / 3 - 1, 0, params->output_height - 1);
      if (j != 4) sums[i] += load_history(history, row * params->output_width + column);
    }
  }
  const EightTexels around = {vload16(0, (const float*)sums), vload16(1, (const float*)sums)};
  return around;
}

// The same where all of them are inside.
static inline EightTexels load_around(HISTORY_TEXELS history, int width, int x, int y) {
  const int index = y * width + x - 1;
  const TwelveTexels above = load_history12(history, index - width), same = load_history12(history, index);
  const TwelveTexels below = load_history12(history, index + width);
  const TwelveTexels both = {above.first + below.first, above.second + below.second, above.third + below.third};
  const EightTexels middle = next_texels(both), right = second_texels(both), beside = second_texels(same);
  const EightTexels around = {both.first + right.left + middle.left + (same.first + beside.left),
                              both.second + right.right + middle.right + (same.second + beside.right)};
  return around;
}

static inline EightTexels smooth_little_known(EightTexels pixels, EightTexels around, float8 confidence) {
  const float8 little = select((float8)(0.0f), (float8)(NEIGHBOUR_WEIGHT), confidence < LITTLE);
  const float8 other = little * bell(2.0f * confidence);
  const float8 own = confidence + CENTRE_WEIGHT;
  const float8 scale = 1.0f / (own + 8.0f * other);
  const float8 own_part = select((float8)(1.0f), own * scale, other > 0.0f), other_part = other * scale;
  const EightTexels smooth = {pixels.left * to_four_texels(own_part.lo) + around.left * to_four_texels(other_part.lo),
                              pixels.right * to_four_texels(own_part.hi) + around.right * to_four_texels(other_part.hi)};
  return smooth;
}
#endif

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

#define EIGHT(step)                                                                                             \
  step(left.s0123, 0); step(left.s4567, 1); step(left.s89ab, 2); step(left.scdef, 3);                           \
  step(right.s0123, 4); step(right.s4567, 5); step(right.s89ab, 6); step(right.scdef, 7)

#define STORE(part, i) \
  if (x + i < end) store_output(output, params.output, x + i, y, (float4)(pixels.shown.part.xyz, alphas[i]))

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
  for (int x = first; x < end; x += kTemporalTile) {
    const Display display = display_of(tiles[y / kTemporalTile * params.tiles_x + x / kTemporalTile]);
    const int y0 = y - display.step_y;
    const bool inside = x >= display.step_x && y0 >= 0 && x + 11 <= width && y0 + 4 <= height;
    Pixels pixels = inside ? load_pixels(history, width, &display, x, y) : gather_pixels(history, &params, &display, x, y);
#if SMOOTH
    const float8 confidence = confidences(pixels.own);
    if (!params.first && any_lane(confidence < LITTLE)) {
      const EightTexels around = inside ? load_around(history, width, x, y) : gather_around(history, &params, x, y);
      pixels.shown = smooth_little_known(pixels.shown, around, confidence);
    }
#endif
    float alphas[8] = {1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f};
#if ALPHA
    for (int i = 0; i < min(end - x, 8); ++i) {
      const Positions column = position_at(positions, x + i, params.columns + x + i, params.frame0.width - 1);
      alphas[i] = alpha_at(&params, colour, row, column);
    }
#endif
    EIGHT(STORE);
  }
}
