// SPDX-License-Identifier: MIT
// The places of pixels of a row of an output among the texels of a history of another size.
#pragma once

#include "arithmetic.h"
#include "temporal/fetch_history.h"
#include "temporal/temporal_params.h"

typedef struct ResizedPixels {
  Positions column, row;  // places of the pixels' centres, anywhere; all share their row
  LaneInt x;                 // the texel nearest to each
  int y;
  LaneFloat phase_x, phase_y;  // phases of the layer's texels there, history's pixels
} ResizedPixels;

// Returns the position of output row y among history's texels, the same in all lanes.
static inline Positions row_among_texels(const ResizeParams* params, __global const int* positions, int y) {
  const int texel = positions[2 * params->columns + y];
  const float fraction = as_float(positions[2 * params->columns + params->height + y]);
  const Positions row = {(LaneInt)(texel), (LaneFloat)(fraction)};
  return row;
}

// The pixels from column x on, without phases.
static inline ResizedPixels pixels_among_texels(const ResizeParams* params, __global const int* positions, int x,
                                                Positions row) {
  ResizedPixels pixels;
  pixels.column = load_positions(positions, params->columns, x);
  pixels.row = row;
  pixels.x = clamp(nearest_samples(pixels.column), (LaneInt)(0), (LaneInt)(params->previous_width - 1));
  pixels.y = clamp(FIRST_LANE(nearest_samples(row)), 0, params->previous_height - 1);
  pixels.phase_x = (LaneFloat)(0.0f);
  pixels.phase_y = (LaneFloat)(0.0f);
  return pixels;
}

// The tile of the history that holds texel (x, y).
static inline int previous_tile(const ResizeParams* params, int x, int y) {
  return y / kTemporalTile * params->previous_tiles_x + x / kTemporalTile;
}

// On one axis, from a pixel's centre to the i-th of its places, in texels.
static inline float way_to_place(int i, int places, float ratio) {
  return ((float)(2 * i + 1 - places) / (float)(2 * places)) * ratio;
}

// Where the pictures of the pixels' places (i, j) are, no further out than the outermost texels.
static inline SourcePlaces places_among_texels(const ResizeParams* params, const ResizedPixels* pixels, int i, int j) {
  const LaneFloat way_x = way_to_place(i, params->places_x, params->ratio_x) - pixels->phase_x;
  const LaneFloat way_y = way_to_place(j, params->places_y, params->ratio_y) - pixels->phase_y;
  SourcePlaces places = {moved_positions(pixels->column, way_x, params->previous_width - 1),
                         moved_positions(pixels->row, way_y, params->previous_height - 1)};
  places.x.texel -= 1;
  places.y.texel -= 1;
  return places;
}
