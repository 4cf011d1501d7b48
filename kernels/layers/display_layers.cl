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
//   listed        in      the tiles that are layered, in any order; other VIEWs look at all
//   total         in      TotalLight: how many those are
//   history       in      the far layer
//   alpha         in      ALPHA 1: its alpha
//   near_history  in      the near layer
//   states        in      LayerState of each texel of a layered tile
//   output        in/out  RGBA32F or RGBA16F, output extent
//   exposure      in      Exposure of this frame
// Options: ALPHA 0 (default) | 1: layers have alpha; 0: they are opaque
//          VIEW  PICTURE (default) | LAYERS, COVERAGE, NEAR: what layers there are, in every pixel: red where there are
//                two, green the near one's coverage, blue the far one's confidence; that coverage; the near one alone
//          SOURCE_STORAGE, of depth, and OUTPUT_FORMAT as in texel.h, HISTORY_FORMAT as of temporal_display
// Reference: tests/reference/display_layers.cpp
#ifndef ALPHA
#define ALPHA 0
#endif
#if ALPHA < 0 || ALPHA > 1
#error "ALPHA must be 0 or 1"
#endif
#include "bits.h"
#include "layers/constants.h"
#include "layers/past_layers.h"
#include "layers/tile_runs.h"
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

#if VIEW == PICTURE
// Shows pixels. `far` is the picture so far, `confidence` that of the far layer, as stored: its sign tells whether
// there are two layers. Where there is one, `near` and `near_alpha` are 0.
static inline LaneTexels shown_of(LaneTexels far, LaneTexels near, LaneFloat near_alpha, LaneFloat confidence) {
  const LaneFloat covered = last_channels(near), coverage = clamp(covered, 0.0f, 1.0f);
  const LaneFloat unknown = clamp(1.0f - fabs(confidence) / CONFIDENCE_MIN, 0.0f, 1.0f);
  const LaneMask is_stood_in = (unknown > 0.0f) & (coverage > SHOWN_COVERAGE_MIN);
#if ALPHA
  const LaneTexels whole = with_last(near, near_alpha), laid = whole;
#else
  const LaneTexels whole = near, laid = with_last(near, coverage);
#endif
  const LaneTexels behind = select_texels(far, move_to(far, over(whole, covered), unknown), is_stood_in);
  const LaneTexels composed = add_times(laid, behind, 1.0f - coverage);
  return select_texels(far, composed, as_lane_int(confidence) < 0);
}
#else
static inline LaneTexels shown_of(LaneTexels far, LaneTexels near, LaneFloat near_alpha, LaneFloat confidence) {
  const LaneFloat one = (LaneFloat)(1.0f);
#if VIEW == LAYERS
  const LaneFloat has_two = select((LaneFloat)(0.0f), one, as_lane_int(confidence) < 0);
  return texels_of(has_two, last_channels(near), fabs(confidence) * (1.0f / CONFIDENCE_MAX), one);
#elif VIEW == COVERAGE
  return texels_of(last_channels(near), last_channels(near), last_channels(near), one);
#else
  return with_last(near, one);
#endif
}
#endif

// Loads the first `count` of the pixels from `index` on.
static inline LaneTexels load_pixels(OUTPUT_TEXELS texels, int index, int count) {
  LaneTexels pixels = no_texels();
#if LANES == 8
  if (count >= kLanes) {
#if OUTPUT_FORMAT == HALF
    pixels.left = load_half_texels4(texels, index);
    pixels.right = load_half_texels4(texels, index + 4);
#else
    pixels.left = vload16(0, texels + 4 * index);
    pixels.right = vload16(1, texels + 4 * index);
#endif
    return pixels;
  }
#endif
  for (int i = 0; i < kLanes; ++i) {
    const int at = index + min(i, count - 1);
#if OUTPUT_FORMAT == HALF
    pixels = push_texel(pixels, vload_half4(at, texels));
#else
    pixels = push_texel(pixels, vload4(at, texels));
#endif
  }
  return pixels;
}

// Loads a layer's texels of the pixels from (x, y) on.
static inline LaneTexels load_pixels_of(const PastLayers* known, HistoryLayer layer, int x, int y) {
#if LANES == 8
  const LaneTexels texels = {load_row(layer, window_at(known, x, y, 1), 0),
                             load_row(layer, window_at(known, x + 4, y, 1), 0)};
  return texels;
#else
  return load_history_lanes(layer, y * layer.width + x);
#endif
}

#if LANES == 8
// Loads twelve texels of the near layer's picture, side by side.
static inline TwelveTexels load_near_row12(const PastLayers* known, DEPTH_TEXELS depth, float between,
                                           const RowWindows* windows, int row) {
  const TwelveTexels texels = {load_near_row(known, depth, between, windows->first, row),
                               load_near_row(known, depth, between, windows->second, row),
                               load_near_row(known, depth, between, windows->third, row)};
  return texels;
}

// Resamples the near layer at the pixels from (x, y) on; those of one layer may get anything.
static inline LaneTexels sample_near(const PastLayers* known, DEPTH_TEXELS depth, float between, Display display, int x,
                                     int y) {
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
static inline LaneTexels sample_near(const PastLayers* known, DEPTH_TEXELS depth, float between, Display display, int x,
                                     int y) {
  if (!display.has_phase) return load_pixels_of(known, known->near, x, y);
  const TexelWindow window = window_at(known, x - display.step_x, y - display.step_y, 4);
  return sample_neighbourhood(load_near_texels(known, depth, between, window), display.wx, display.wy);
}
#endif

// Resamples its alphas, which are multiplied by coverage, in `lanes`; of the others 0.
static inline LaneFloat near_alphas(const PastLayers* known, DEPTH_TEXELS depth, float between, Display display, int x,
                                    int y, LaneMask lanes) {
  LaneFloat found = (LaneFloat)(0.0f);
#if ALPHA
  for (int i = 0; i < kLanes; ++i) {
    if (FIRST_LANE(lanes)) {
      const int at = x + i;
      FIRST_LANE(found) =
          display.has_phase ? sample_near_alpha(known, depth, between, at - display.step_x, y - display.step_y,
                                                display.wx, display.wy)
                            : load_state(known->states, y * known->far.width + at).near_alpha;
    }
    lanes = NEXT_LANES(lanes);
    found = NEXT_LANES(found);
  }
#endif
  return found;
}

__kernel void display_layers(const TemporalDisplayParams params, const HistorySamples now, DEPTH_TEXELS depth,
                             __global const TileReprojection* tiles, __global const LayerTile* layers,
                             __global const int* listed, __global const TotalLight* total, HISTORY_TEXELS history,
                             HISTORY_TEXELS alpha, HISTORY_TEXELS near_history, __global const half* states,
                             OUTPUT_TEXELS output, __global const Exposure* exposure) {
  const int all = params.tiles_x * ((params.output_height + kTemporalTile - 1) / kTemporalTile);
  const ItemRuns runs = runs_of_item(VIEW == PICTURE ? total->layered : all);
  const PastLayers known =
      past_layers(params.output_width, params.output_height, now, history, alpha, near_history, states, tiles, layers);
  for (int run = runs.first; run < runs.end; run += runs.step) {
    const int tile = VIEW == PICTURE ? listed[run / kRunsOfTile] : run / kRunsOfTile;
    const LayerTile layer = layers[tile];
    if (VIEW == PICTURE && !layer.is_split) continue;
    const int2 pixel = pixel_of_run(run, tile, params.tiles_x);
    const int x = pixel.x, y = pixel.y;
    if (x >= params.output_width || y >= params.output_height) continue;
    const LaneFloat confidence = confidences(load_pixels_of(&known, known.far, x, y));
    const bool any_split = layer.is_split && any_lane(as_lane_int(confidence) < 0);
    if (VIEW == PICTURE && !any_split) continue;
    const Display display = display_of(layer.phase_x, layer.phase_y);
    LaneTexels near = no_texels();
    LaneFloat near_alpha = (LaneFloat)(0.0f);
    const LaneMask is_split = as_lane_int(confidence) < 0;
    const int index = texel_index(params.output, x, y), count = min(params.output_width - x, (int)kLanes);
    if (any_split) {
      near = sample_near(&known, depth, layer.between, display, x, y);
      near_alpha = near_alphas(&known, depth, layer.between, display, x, y, is_split & (LANE_NUMBERS < count));
    }
    const LaneTexels known_near = exposed(select_texels(no_texels(), near, is_split), exposure->inverse);
    const LaneTexels far = load_pixels(output, index, count);
    stream_output_lanes(output, params.output, x, y, count, shown_of(far, known_near, near_alpha, confidence));
  }
}
