// SPDX-License-Identifier: MIT
// The evidence of the whole picture: a work-item sums its tiles and adds the sum once, because processors that add to
// one place in turn wait for each other.
#pragma once

#include "temporal/temporal_params.h"

// Found by search on the development scenes.
#define LEAST_CHANGED 0.03f    // of a tile's light: less error is no change of the picture

// Adds the means of a tile to a sum of such, in units that leave no total beyond an int.
static inline void add_means(TotalLight* sum, const TemporalTileParams* params, TileEvidence tile) {
  const float most = min((float)kLightUnits, 0x1p30f / ((float)params->tiles_x * (float)params->tiles_y));
  const float units = most / max(tile.count, 1.0f);
  sum->brightening += convert_int(tile.brightening * units);
  sum->change += convert_int(fabs(tile.brightening) * units);
  sum->light += convert_int(tile.light * units);
  sum->history_error += convert_int(tile.history_error * units);
  sum->neighbour_error += convert_int(tile.neighbour_error * units);
  sum->changed += tile.history_error > LEAST_CHANGED * tile.light;
}

// Adds the sum of a work-item's tiles to that of the picture.
static inline void add_to_total(__global TotalLight* total, TotalLight sum) {
  atomic_add(&total->brightening, sum.brightening);
  atomic_add(&total->change, sum.change);
  atomic_add(&total->light, sum.light);
  atomic_add(&total->history_error, sum.history_error);
  atomic_add(&total->neighbour_error, sum.neighbour_error);
  atomic_add(&total->changed, sum.changed);
}
