// SPDX-License-Identifier: MIT
// display_layers: lays the near layer over the picture that temporal_display has made of the far one:
// near + (1 - coverage) far, the near layer resampled at the pixel's centre where it has a phase. The near layer's
// colour stands in for a far one without samples. Pixels of one layer stay as they are.
//
//   params        in      as in temporal_display
//   now           in      this frame's samples
//   depth         in      R32F, viewport
//   tiles         in      TileReprojection of each tile
//   layers        in      LayerTile of each tile
//   history       in      the far layer
//   near_history  in      the near layer
//   states        in      LayerState of each texel of a layered tile
//   output        in/out  RGBA32F or RGBA16F, output extent
// Options: VIEW  PICTURE (default) | LAYERS, COVERAGE, NEAR: what layers there are, in every pixel: red where there are
//                two, green the near one's coverage, blue the far one's confidence; that coverage; the near one alone
//          SOURCE_STORAGE, OUTPUT_FORMAT, HISTORY_FORMAT as of temporal_display
// Reference: tests/reference/display_layers.cpp
#define ALPHA 0
#include "bits.h"
#include "layers/constants.h"
#include "layers/past_layers.h"
#include "temporal/constants.h"
#include "temporal/display.h"

#define PICTURE 1
#define LAYERS 2
#define COVERAGE 3
#define NEAR 4
#ifndef VIEW
#define VIEW PICTURE
#endif
#if VIEW != PICTURE && VIEW != LAYERS && VIEW != COVERAGE && VIEW != NEAR
#error "VIEW must be PICTURE, LAYERS, COVERAGE or NEAR"
#endif

// Tells each channel of four pixels whether there are two layers.
static inline int16 two_layers(float4 confidence) {
  return to_four_masks(as_int4(confidence) >> 31);
}

#if VIEW == PICTURE
// Shows four pixels. `far` is the picture so far, `confidence` that of the far layer, as stored: its sign tells whether
// there are two layers. Where there is one, `near` is 0.
static inline float16 shown_of(float16 far, float16 near, float4 confidence) {
  const float16 covered = to_four_texels(near.s37bf), coverage = clamp(covered, 0.0f, 1.0f);
  const float16 unknown = to_four_texels(clamp(1.0f - fabs(confidence) / CONFIDENCE_MIN, 0.0f, 1.0f));
  const int16 is_stood_in = (unknown > 0.0f) & (coverage > SHOWN_COVERAGE_MIN);
  const float16 behind = select(far, far + (near / covered - far) * unknown, is_stood_in);
  const float16 composed = select(near, coverage, LAST_CHANNELS) + (1.0f - coverage) * behind;
  return select(far, composed, two_layers(confidence));
}
#else
static inline float4 view_of(float4 near, float confidence) {
#if VIEW == LAYERS
  return (float4)(as_int(confidence) < 0 ? 1.0f : 0.0f, near.w, fabs(confidence) * (1.0f / CONFIDENCE_MAX), 1.0f);
#elif VIEW == COVERAGE
  return (float4)(near.w, near.w, near.w, 1.0f);
#else
  return (float4)(near.xyz, 1.0f);
#endif
}

static inline float16 shown_of(float16 far, float16 near, float4 confidence) {
  return (float16)(view_of(near.s0123, confidence.x), view_of(near.s4567, confidence.y),
                   view_of(near.s89ab, confidence.z), view_of(near.scdef, confidence.w));
}
#endif

// Loads the first `count` of the four pixels from `index` on; the others are 0.
static inline float16 load_pixels(OUTPUT_TEXELS texels, int index, int count) {
#if OUTPUT_FORMAT == HALF
  if (count >= 4) return load_half_texels4(texels, index);
  float4 texel[4] = {(float4)(0.0f), (float4)(0.0f), (float4)(0.0f), (float4)(0.0f)};
  for (int i = 0; i < count; ++i) texel[i] = vload_half4(index + i, texels);
#else
  if (count >= 4) return vload16(0, texels + 4 * index);
  float4 texel[4] = {(float4)(0.0f), (float4)(0.0f), (float4)(0.0f), (float4)(0.0f)};
  for (int i = 0; i < count; ++i) texel[i] = vload4(index + i, texels);
#endif
  return vload16(0, (const float*)texel);
}

// Stores finite values; half saturates instead of becoming infinite.
static inline void store_pixels(OUTPUT_TEXELS texels, int index, int count, float16 pixels) {
#if OUTPUT_FORMAT == HALF
  const float16 held = clamp(pixels, -FINITE_HALF_MAX, FINITE_HALF_MAX);
  if (count >= 4) {
    store_half_texels4(texels, index, held);
    return;
  }
  float4 texel[4];
  vstore16(held, 0, (float*)texel);
  for (int i = 0; i < count; ++i) vstore_half4_rte(texel[i], index + i, texels);
#else
  if (count >= 4) {
    vstore16(pixels, 0, texels + 4 * index);
    return;
  }
  float4 texel[4];
  vstore16(pixels, 0, (float*)texel);
  for (int i = 0; i < count; ++i) vstore4(texel[i], index + i, texels);
#endif
}

// Shows the first `count` of four pixels with what the near layer has of them.
static inline void show_pixels(OUTPUT_TEXELS output, int index, int count, float16 near, float4 confidence) {
  if (count < 1) return;
  const float16 far = load_pixels(output, index, count);
  const float16 known = select((float16)(0.0f), near, two_layers(confidence));
  store_pixels(output, index, count, shown_of(far, known, confidence));
}

// Loads a layer's texels of the pixels from (x, y) on.
static inline EightTexels load_pixels_of(const PastLayers* known, HistoryLayer layer, int x, int y) {
#if ON_CPU
  const EightTexels texels = {load_row(layer, window_at(known, x, y, 1), 0),
                              load_row(layer, window_at(known, x + 4, y, 1), 0)};
  return texels;
#else
  return load_history_lanes(layer, y * layer.width + x);
#endif
}

#if ON_CPU
// Loads twelve texels of the near layer's picture, side by side.
static inline TwelveTexels load_near_row12(const PastLayers* known, DEPTH_TEXELS depth, float between,
                                           const RowWindows* windows, int row) {
  const TwelveTexels texels = {load_near_row(known, depth, between, windows->first, row),
                               load_near_row(known, depth, between, windows->second, row),
                               load_near_row(known, depth, between, windows->third, row)};
  return texels;
}

// Resamples the near layer at the pixels from (x, y) on; those of one layer may get anything.
static inline EightTexels sample_near(const PastLayers* known, DEPTH_TEXELS depth, float between, Display display,
                                      int x, int y) {
  if (!display.has_phase) return load_pixels_of(known, known->near, x, y);
  const RowWindows windows = windows_from(known, x - display.step_x, y - display.step_y, 4, true);
  const float16 none = (float16)(0.0f);
  TwelveTexels row0, row1, row2, row3 = {none, none, none};
  row0 = row1 = row2 = row3;
  UNROLL(4)
  for (int row = 0; row < 4; ++row) {
    row0 = row1;
    row1 = row2;
    row2 = row3;
    row3 = load_near_row12(known, depth, between, &windows, row);
  }
  return blend_rows(row0, row1, row2, row3, display.wx, display.wy);
}
#else
// The same of one pixel.
static inline EightTexels sample_near(const PastLayers* known, DEPTH_TEXELS depth, float between, Display display,
                                      int x, int y) {
  if (!display.has_phase) return load_pixels_of(known, known->near, x, y);
  const TexelWindow window = window_at(known, x - display.step_x, y - display.step_y, 4);
  return push_texel(no_texels(),
                    sample_neighbourhood(load_near_texels(known, depth, between, window), display.wx, display.wy));
}
#endif

__kernel void display_layers(const TemporalDisplayParams params, const HistorySamples now, DEPTH_TEXELS depth,
                             __global const TileReprojection* tiles, __global const LayerTile* layers,
                             HISTORY_TEXELS history, HISTORY_TEXELS near_history, __global const half* states,
                             OUTPUT_TEXELS output) {
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(params.columns_per_item, params.output_width, kLanes);
  if (item.first >= item.end || y >= params.output_height) return;

  const PastLayers known =
      past_layers(params.output_width, params.output_height, now, history, 0, near_history, states, tiles, layers);
  for (int x = item.first; x < item.end; x += item.step) {
    const LayerTile layer = layers[y / kTemporalTile * params.tiles_x + x / kTemporalTile];
    if (VIEW == PICTURE && !layer.is_split) continue;
    const float8 confidence = confidences(load_pixels_of(&known, known.far, x, y));
    const bool any_split = layer.is_split && any_lane(as_int8(confidence) < 0);
    if (VIEW == PICTURE && !any_split) continue;
    const Display display = display_of(layer.phase_x, layer.phase_y);
    EightTexels near = {(float16)(0.0f), (float16)(0.0f)};
    if (any_split) near = sample_near(&known, depth, layer.between, display, x, y);
    const int index = texel_index(params.output, x, y), count = pixels_from(item, x);
    show_pixels(output, index, count, near.left, confidence.lo);
    show_pixels(output, index + 4, count - 4, near.right, confidence.hi);
  }
}
