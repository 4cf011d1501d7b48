// SPDX-License-Identifier: MIT
// How work-items share the tiles of a list among them. A *run* is as many pixels of a row as an item makes at once.
// With eight lanes an item takes all runs of a tile, and then another tile. With one, items side by side take runs side
// by side.
#pragma once

#include "lanes.h"
#include "temporal/tile.h"

enum { kRunsOfRow = kTemporalTile / kLanes, kRunsOfTile = kRunsOfRow * kTemporalTile };
enum { kRunsInTurn = kLanes == 1 ? 1 : kRunsOfTile };  // that an item takes before those of the other items

static inline int first_run(void) {
  return get_global_id(0) * kRunsInTurn;
}

static inline int next_run(int run) {
  const int next = run + 1;
  return next % kRunsInTurn != 0 ? next : next + ((int)get_global_size(0) - 1) * kRunsInTurn;
}

// Returns the first pixel of a run in a tile of a picture of `tiles_x` tiles in a row.
static inline int2 pixel_of_run(int run, int tile, int tiles_x) {
  const int place = run % kRunsOfTile;
  return (int2)(tile % tiles_x * kTemporalTile + place % kRunsOfRow * kLanes,
                tile / tiles_x * kTemporalTile + place / kRunsOfRow);
}
