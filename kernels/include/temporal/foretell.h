// SPDX-License-Identifier: MIT
// What history foretells of samples: its colour at their places, which lie beside those of the pixels. It stands in for
// samples that are held back. Without it a pixel of resampled history would lack a sample for that frame, and show it.
#pragma once

#include "temporal/fetch_history.h"
#include "temporal/nearest_samples.h"

// Those of eight texels that a rigid tile's pixels from (x, y) on copy.
static inline SourcePlaces copied_places(TileReprojection tile, int x, int y) {
  const SourcePlaces places = {{x - tile.step_x - 1 + (int8)(0, 1, 2, 3, 4, 5, 6, 7), (float8)(0.0f)},
                               {(int8)(y - tile.step_y - 1), (float8)(0.0f)}};
  return places;
}

// Of the samples nearest to the tile's pixels from (x, y) on: bilinear.
static inline EightTexels foretell_samples(HistoryLayer layer, __global const TileReprojection* previous,
                                           const TemporalParams* params, TileReprojection tile, bool copied,
                                           const EightReprojections* motion, const NearestSamples* nearest, int x,
                                           int y) {
  SourcePlaces at = copied ? copied_places(tile, x, y) : source_places(previous, params, tile, motion, x, y);
  at.x = shifted_positions(at.x, -nearest->from_x * params->spacing_x);
  at.y = shifted_positions(at.y, (float8)(-nearest->from_y * params->spacing_y));
  return sample_places(layer, at, lie_inside(at.x.texel, at.y.texel, layer.width, layer.height),
                       tent_weights(at.x.fraction), tent_weights(at.y.fraction));
}

// The samples, with what is foretold in place of those of `held`.
static inline EightTexels with_foretold(EightTexels samples, EightTexels foretold, float8 alpha, int8 held) {
  const int16 left = held.s0000111122223333, right = held.s4444555566667777;
  foretold.left = select(foretold.left, to_four_texels(alpha.lo), LAST_CHANNELS);
  foretold.right = select(foretold.right, to_four_texels(alpha.hi), LAST_CHANNELS);
  const EightTexels all = {select(samples.left, foretold.left, left), select(samples.right, foretold.right, right)};
  return all;
}
