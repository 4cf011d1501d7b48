// SPDX-License-Identifier: MIT
// Plain tiles: those whose history is copied as it is, in the light that it has. Most are where things stand still or
// move as one. A row of such a tile takes a third of the instructions of any other, and gives the same bits.
#pragma once

#include "temporal/accumulate.h"
#include "temporal/fetch_history.h"
#include "temporal/limit_confidence.h"
#include "temporal/nearest_samples.h"
#include "temporal/reprojection.h"

enum { kPlainAhead = 6 * kTemporalTile };  // texels to prefetch

// Whether the rows from `first` to `last` of a tile that is in even light are plain; x is its first column.
static inline bool is_plain(__global const TileReprojection* previous, const TemporalParams* params,
                            TileReprojection tile, int x, int first, int last) {
  return tile.is_copyable && params->parity < 0 && x + kTemporalTile <= params->output_width &&
         is_copied(previous, params, tile, x, first) && is_copied(previous, params, tile, x, last);
}

// Adds samples to eight pixels of a plain tile, from (x, y) on. False if they need more than that: if too little is
// known of them, or a sample is bright, not finite or reactive. Then nothing is stored.
static inline bool resolve_plain_pixels(const TemporalParams* params, COLOUR_TEXELS colour, REACTIVE_TEXELS reactive0,
                                        REACTIVE_TEXELS reactive1, HistoryLayer layer, TileReprojection tile,
                                        const NearestSamples* nearest, STORED_HISTORY updated, int x, int y) {
  const int index = y * params->output_width + x;
  const int from = index - tile.step_y * params->output_width - tile.step_x;
  will_read_history(layer, from + kPlainAhead);
  WILL_WRITE(updated + 4 * (index + kPlainAhead));
  if (!is_taken_whole(params, reactive0, reactive1, nearest, tile, true)) return false;
  const FetchedHistory fetched = copy_history(layer, x - tile.step_x, y - tile.step_y);
  const EightTexels samples = load_samples(colour, params->frame0.colour, nearest->x, nearest->y);
  if (any_lane(fetched.confidence < LEAST_CONFIDENCE) || may_be_bright(samples)) return false;
  const float8 weight = distance_weights(params, nearest, reach_of(tile, fetched.confidence));
  const EightTexels sum = accumulate(fetched.texels, fetched.confidence, (float8)(0.0f), samples, weight);
  store_history8(updated, index, kTemporalTile, sum);
  return true;
}
