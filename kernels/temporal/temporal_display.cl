// SPDX-License-Identifier: MIT
// temporal_display: makes the picture of a history: resampled at the pixels' centres where a tile has a phase, and
// smoothed where confidence is low. The result is not fed back.
//   A pixel of confidence W < 1.5 becomes a weighted mean: it counts W + .02 and its eight neighbours .3 exp(-2 W)
//   each, or its own texel in place of neighbours of the other kind, of one layer or of two. The picture of a first
//   frame is not smoothed: it would lose what it has of fine texture.
//
//   params     in   extents, layouts
//   tiles      in   TileReprojection of each tile, of this frame
//   history    in   the layer of this frame; of pixels of two layers the far one
//   alpha      in   ALPHA 1: its alpha, resampled and smoothed as colour is
//   output     out  RGBA32F or RGBA16F, output extent: scene light, as all pictures are
//   exposure   in   Exposure of this frame
// Options: ALPHA   1 (default) | 0: the picture is opaque
//          SMOOTH  1 (default) | 0
//          OUTPUT_FORMAT as in texel.h, HISTORY_FORMAT as in temporal/history.h
// Reference: tests/reference/temporal_display.cpp
#include "bits.h"
#include "picture_params.h"
#include "temporal/constants.h"
#include "temporal/display.h"
#include "temporal/history.h"
#include "temporal/history_sampling.h"
#include "temporal/temporal_params.h"
#include "texel.h"
#include "texels/resolved.h"

#ifndef ALPHA
#define ALPHA 1
#endif
#if ALPHA < 0 || ALPHA > 1
#error "ALPHA must be 0 or 1"
#endif

// Pixels: as history holds them, and as they are shown.
typedef struct Pixels {
  LaneTexels own, shown;
} Pixels;

// Returns the tile's pixels from (x, y) on, anywhere, clamped to the edge. The slow path.
static inline Pixels gather_pixels(HistoryLayer layer, const Display* display, int x, int y) {
  Pixels pixels = {no_texels(), no_texels()};
  for (int i = 0; i < kLanes; ++i) {
    const int column = min(x + i, layer.width - 1);
    const float4 own = load_history(layer, y * layer.width + column);
    float4 shown = own;
    if (display->has_phase)
      shown = sample_history(layer, column - display->step_x, y - display->step_y, false, display->wx, display->wy);
    pixels.own = push_texel(pixels.own, own);
    pixels.shown = push_texel(pixels.shown, shown);
  }
  return pixels;
}

#if LANES == 8
// Whether all texels that the cubic and load_around() need are inside.
static inline bool lies_inside(HistoryLayer layer, const Display* display, int x, int y) {
  const int first_y = y - display->step_y;
  return x >= display->step_x && first_y >= 0 && x + 11 <= layer.width && first_y + 4 <= layer.height;
}

// The same where they are. `has_rows`: `rows` are those of the row above.
static inline Pixels load_pixels(HistoryLayer layer, const Display* display, int x, int y, FilteredRows* rows,
                                 bool* has_rows) {
  Pixels pixels;
  pixels.own = load_history_lanes(layer, y * layer.width + x);
  pixels.shown = pixels.own;
  if (!display->has_phase) return pixels;
  const int index = (y - display->step_y) * layer.width + x - display->step_x;
  *rows = *has_rows ? next_rows(*rows, layer, index, display->wx) : filter_rows(layer, index, display->wx);
  *has_rows = true;
  pixels.shown = blend_filtered(rows, display->wy);
  return pixels;
}
#endif

// Whether any of the pixels is.
static inline bool is_smoothed(const TemporalDisplayParams* params, LaneFloat confidence) {
#if SMOOTH
  return !params->first && any_lane(confidence < SMOOTHED_CONFIDENCE_MAX);
#else
  return false;
#endif
}

#if ALPHA
// The sum of alpha of a pixel's eight neighbours, as gather_around() has it.
static inline float alpha_around(HistoryLayer layer, AlphaPlane plane, int x, int y) {
  const float own = load_history(layer, y * layer.width + x).w, own_alpha = load_alpha(plane, y * plane.width + x);
  float sum = 0.0f;
  for (int j = 0; j < 9; ++j) {
    const int column = clamp(x + j % 3 - 1, 0, plane.width - 1), row = clamp(y + j / 3 - 1, 0, plane.height - 1);
    const int index = row * plane.width + column;
    const bool is_other = is_other_kind(load_history(layer, index).w, own);
    if (j != 4) sum += is_other ? own_alpha : load_alpha(plane, index);
  }
  return sum;
}

// Finds the alpha that is shown of the first `count` pixels from (x, y) on.
static inline LaneFloat show_alpha(HistoryLayer layer, AlphaPlane plane, const Display* display, int x, int y,
                                   int count, bool smooth, LaneFloat confidence) {
  SmoothParts parts = smooth_parts(confidence);
  LaneFloat shown = (LaneFloat)(1.0f);
  for (int i = 0; i < kLanes; ++i) {
    if (i < count) {
      FIRST_LANE(shown) = load_alpha(plane, y * plane.width + x + i);
      if (display->has_phase)
        FIRST_LANE(shown) = sample_alpha(plane, x + i - display->step_x, y - display->step_y, display->wx, display->wy);
      const float own = FIRST_LANE(parts.own), other = FIRST_LANE(parts.other);
      if (smooth) FIRST_LANE(shown) = FIRST_LANE(shown) * own + alpha_around(layer, plane, x + i, y) * other;
    }
    shown = NEXT_LANES(shown);
    parts.own = NEXT_LANES(parts.own);
    parts.other = NEXT_LANES(parts.other);
  }
  return shown;
}

// The first `count` of the pixels.
static inline void store_pixels(OUTPUT_TEXELS output, TexelLayout layout, int x, int y, int count, LaneTexels texels,
                                LaneFloat alphas) {
  for (int i = 0; i < min(count, (int)kLanes); ++i) {
    store_output(output, layout, x + i, y, (float4)(first_texel(texels).xyz, FIRST_LANE(alphas)));
    texels = push_texel(texels, first_texel(texels));
    alphas = NEXT_LANES(alphas);
  }
}
#endif

__kernel void temporal_display(const TemporalDisplayParams params, __global const TileReprojection* tiles,
                               HISTORY_TEXELS history, HISTORY_TEXELS alpha, OUTPUT_TEXELS output,
                               __global const Exposure* exposure) {
  const int first_y = get_global_id(1) * kTemporalTile;
  const ItemColumns item = columns_of_item(params.columns_per_item, params.output_width, kLanes);
  if (item.first >= item.end || first_y >= params.output_height) return;

  const HistoryLayer layer = {history, params.output_width, params.output_height};
  const float inverse = exposure->inverse;
  const int end_y = min(first_y + kTemporalTile, params.output_height);
  for (int x = item.first; x < item.end; x += item.step) {
    const int count = pixels_from(item, x);
    const TileReprojection tile = tiles[first_y / kTemporalTile * params.tiles_x + x / kTemporalTile];
    const Display display = display_of(tile.phase_x, tile.phase_y);
#if LANES == 8
    FilteredRows rows;
    bool has_rows = false;
#endif
    for (int y = first_y; y < end_y; ++y) {
      // Resample.
#if LANES == 8
      const bool inside = lies_inside(layer, &display, x, y);
      Pixels pixels = inside ? load_pixels(layer, &display, x, y, &rows, &has_rows)
                             : gather_pixels(layer, &display, x, y);
#else
      Pixels pixels = gather_pixels(layer, &display, x, y);
#endif

      // Smooth.
      const LaneFloat confidence = fabs(confidences(pixels.own));
      const bool smooth = is_smoothed(&params, confidence);
      if (smooth) {
#if LANES == 8
        const LaneTexels around = inside ? load_around(layer, x, y) : gather_around(layer, x, y);
#else
        const LaneTexels around = gather_around(layer, x, y);
#endif
        pixels.shown = smooth_little_known(pixels.shown, around, smooth_parts(confidence));
      }

      // Store.
      pixels.shown = times(pixels.shown, (LaneFloat)(inverse));
#if ALPHA
      const AlphaPlane plane = {alpha, params.output_width, params.output_height};
      const LaneFloat alphas = show_alpha(layer, plane, &display, x, y, min(count, (int)kLanes), smooth, confidence);
      store_pixels(output, params.output, x, y, count, pixels.shown, alphas);
#else
      stream_output_lanes(output, params.output, x, y, count, with_last(pixels.shown, (LaneFloat)(1.0f)));
#endif
    }
  }
}
