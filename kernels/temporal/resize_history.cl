// SPDX-License-Identifier: MIT
// resize_history: resizes the history to another output, so that it goes on where the output's resolution changes.
//   A pixel is the mean of the history at its places, by the cubic of resolve_temporal. On an axis of at most 1.5
//   texels a pixel there is one place, the pixel's centre; else there are as many as texels, rounded up, 4 at most.
//   A texel holds its picture at its centre + its tile's phase; here phases end.
//   Confidence is that of the texel nearest to the pixel's centre, with its sign, times params.share: a texel that
//   becomes several pixels has no more samples than before. At most params.most is left: 8, as of all history that was
//   resampled, or 1 where the output grows, so that the detail that history cannot have soon replaces its blur.
//
//   params          in   extents, places
//   positions       in   of each output column, then row, among the texels, as in resolve_reprojected
//   previous_tiles  in   TileReprojection of each tile of the history: phases
//   history         in   the layer; of pixels of two layers the far one
//   alpha           in   ALPHA 1: its alpha
//   resized         out  the layer in the output's size
//   resized_alpha   out  ALPHA 1: its alpha
// Options: ALPHA  0 (default) | 1
//          HISTORY_FORMAT as in temporal/history.h
// Reference: tests/reference/resize_history.cpp
#ifndef ALPHA
#define ALPHA 0
#endif
#if ALPHA < 0 || ALPHA > 1
#error "ALPHA must be 0 or 1"
#endif

#include "arithmetic.h"
#include "temporal/fetch_history.h"
#include "temporal/resized_pixels.h"

// The pixels with the phases of the texels there.
static inline ResizedPixels pixels_with_phases(const ResizeParams* params, __global const int* positions,
                                               __global const TileReprojection* tiles, int x, Positions row) {
  ResizedPixels pixels = pixels_among_texels(params, positions, x, row);
  for (int i = 0; i < kLanes; ++i) {
    __global const TileReprojection* tile = tiles + previous_tile(params, FIRST_LANE(pixels.x), pixels.y);
    FIRST_LANE(pixels.phase_x) = tile->phase_x;
    FIRST_LANE(pixels.phase_y) = tile->phase_y;
    pixels.x = NEXT_LANES(pixels.x);
    pixels.phase_x = NEXT_LANES(pixels.phase_x);
    pixels.phase_y = NEXT_LANES(pixels.phase_y);
  }
  return pixels;
}

// Returns the confidence of the texels nearest to the pixels' centres, less what resizing takes, with their signs.
static inline LaneFloat confidence_left(const ResizeParams* params, HistoryLayer layer, const ResizedPixels* pixels) {
  LaneInt texel = pixels->x;
  LaneFloat stored = (LaneFloat)(0.0f);
  for (int i = 0; i < kLanes; ++i) {
    FIRST_LANE(stored) = load_confidence(layer, pixels->y * layer.width + FIRST_LANE(texel));
    stored = NEXT_LANES(stored);
    texel = NEXT_LANES(texel);
  }
  return copysign(min(fabs(stored) * params->share, params->most), stored);
}

__kernel void resize_history(const ResizeParams params, __global const int* positions,
                             __global const TileReprojection* previous_tiles, HISTORY_TEXELS history,
                             HISTORY_TEXELS alpha, STORED_HISTORY resized, STORED_HISTORY resized_alpha) {
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(params.columns_per_item, params.width, kLanes);
  if (item.first >= item.end || y >= params.height) return;

  const HistoryLayer layer = {history, params.previous_width, params.previous_height};
  const Positions row = row_among_texels(&params, positions, y);
  const float part = 1.0f / (float)(params.places_x * params.places_y);
  for (int x = item.first; x < item.end; x += item.step) {
    const ResizedPixels pixels = pixels_with_phases(&params, positions, previous_tiles, x, row);
    LaneTexels sum = no_texels();
#if ALPHA
    const AlphaPlane plane = {alpha, params.previous_width, params.previous_height};
    LaneFloat sum_alpha = (LaneFloat)(0.0f);
#endif
    for (int place = 0; place < params.places_x * params.places_y; ++place) {
      const SourcePlaces from =
          places_among_texels(&params, &pixels, place % params.places_x, place / params.places_x);
      sum = add_times(sum, resample_history(layer, from).texels, (LaneFloat)(part));
#if ALPHA
      sum_alpha += resample_alpha(plane, from) * part;
#endif
    }
    sum = with_last(sum, confidence_left(&params, layer, &pixels));
    store_history_lanes(resized, y * params.width + x, pixels_from(item, x), sum);
#if ALPHA
    store_alpha_lanes(resized_alpha, y * params.width + x, pixels_from(item, x), sum_alpha);
#endif
  }
}
