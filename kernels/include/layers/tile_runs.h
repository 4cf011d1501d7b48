// SPDX-License-Identifier: MIT
// How work-items share the tiles of a list among them. A *run* is as many pixels of a row as an item makes at once.
// With eight lanes an item takes tiles that follow each other in the list. With one, items side by side take runs side
// by side.
#pragma once

#include "lanes.h"
#include "temporal/tile.h"

enum { kRunsOfRow = kTemporalTile / kLanes, kRunsOfTile = kRunsOfRow * kTemporalTile };

// The runs of a work-item: `first`, `first` + `step` and so on, before `end`.
typedef struct ItemRuns {
  int first, end, step;
} ItemRuns;

// Returns this item's part of those of so many tiles.
static inline ItemRuns runs_of_item(int tiles) {
  const int item = get_global_id(0), items = get_global_size(0);
#if LANES == 8
  const int most = (tiles + items - 1) / items;
  const ItemRuns runs = {min(item * most, tiles) * kRunsOfTile, min((item + 1) * most, tiles) * kRunsOfTile, 1};
#else
  const ItemRuns runs = {item, tiles * kRunsOfTile, items};
#endif
  return runs;
}

// Returns the first pixel of a run in a tile of a picture of `tiles_x` tiles in a row.
static inline int2 pixel_of_run(int run, int tile, int tiles_x) {
  const int place = run % kRunsOfTile;
  return (int2)(tile % tiles_x * kTemporalTile + place % kRunsOfRow * kLanes,
                tile / tiles_x * kTemporalTile + place / kRunsOfRow);
}
