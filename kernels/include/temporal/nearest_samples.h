// SPDX-License-Identifier: MIT
// Which sample of this frame lies nearest to each of eight output pixels of a row, in one tile.
#pragma once

#include "positions.h"
#include "temporal/temporal_params.h"

// A pixel's picture lies at its centre + the tile's phase. All eight share their row, as y's lanes do.
typedef struct NearestSamples {
  int8 x;        // columns of the viewport
  int y;         // row
  // From the sample to the pixel's picture, in samples; beyond the outermost samples more than half of one.
  float8 from_x;
  float from_y;
  Positions between_x, between_y;  // the same place, clamped to the viewport: between which samples it lies
} NearestSamples;

// Of output row y, without a phase.
static inline Positions row_position(const TemporalParams* params, __global const int* positions, int y) {
  const int texel = positions[2 * params->columns + y];
  const float fraction = as_float(positions[2 * params->columns + params->output_height + y]);
  const Positions row = {(int8)(texel), (float8)(fraction)};
  return row;
}

// On a checkerboard, from a sample that is not shaded to the next one of its row that is, on the pixel's own side where
// there is one.
static inline void move_to_shaded(NearestSamples* nearest, const TemporalParams* params) {
  const int last = params->frame0.width - 1;
  const int8 is_shaded = ((nearest->x + nearest->y) & 1) == params->parity;
  int8 step = select((int8)(-1), (int8)(1), nearest->from_x > 0.0f);
  step = select(step, (int8)(1), nearest->x == 0);
  step = select(step, (int8)(-1), nearest->x == last);
  step = select(step, (int8)(0), is_shaded | (int8)(last == 0 ? -1 : 0));
  nearest->x += step;
  nearest->from_x -= convert_float8(step);
}

// Of the pixels from column x on, in a row that is not known yet.
static inline NearestSamples find_nearest_columns(const TemporalParams* params, __global const int* positions, int x,
                                                  TileReprojection tile) {
  Positions place = {vload8(0, positions + x), as_float8(vload8(0, positions + params->columns + x))};
  if (tile.phase_x != 0.0f || tile.phase_y != 0.0f)
    place = shifted_positions(place, (float8)(tile.phase_x / params->spacing_x));
  NearestSamples nearest;
  nearest.between_x = held_positions(place, params->frame0.width - 1);
  nearest.x = nearest_samples(nearest.between_x);
  nearest.from_x = place.fraction + convert_float8(place.texel - nearest.x);
  return nearest;
}

// The same in a row.
static inline NearestSamples in_row(const TemporalParams* params, NearestSamples nearest, Positions row,
                                    TileReprojection tile) {
  Positions place = row;
  if (tile.phase_x != 0.0f || tile.phase_y != 0.0f)
    place = shifted_positions(row, (float8)(tile.phase_y / params->spacing_y));
  nearest.between_y = held_positions(place, params->frame0.height - 1);
  nearest.y = nearest_samples(nearest.between_y).s0;
  nearest.from_y = place.fraction.s0 + (float)(place.texel.s0 - nearest.y);
  if (params->parity >= 0) move_to_shaded(&nearest, params);
  return nearest;
}

// Of the pixels from column x on.
static inline NearestSamples find_nearest_samples(const TemporalParams* params, __global const int* positions, int x,
                                                  Positions row, TileReprojection tile) {
  return in_row(params, find_nearest_columns(params, positions, x, tile), row, tile);
}
