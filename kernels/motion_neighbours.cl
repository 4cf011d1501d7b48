// SPDX-License-Identifier: MIT
// motion_neighbours: finds the streaks that can reach each tile of the output, or be reached from it, while the shutter
// is open, and so how its pixels are blurred.
//   params   in   tiles_x, tiles_y, most_samples_log2
//   tiles    in   TileStreaks of motion_tiles
//   longest  in   longest[0]: the longest streak of all
//   blurs    out  TileBlur of each tile
// The number of samples is the power of two that leaves at most a pixel between two of them, within [4, most].
// Source: McGuire et al. 2012; Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014
// (classes).
#include "motion/blur_params.h"

#define STILL (kStreakUnits / 2)  // half a pixel
#define ALIKE (kStreakUnits / 4)  // a quarter

static inline int reach_of(TileStreaks tile) {
  return (int)max(max(abs(tile.least_x), abs(tile.most_x)), max(abs(tile.least_y), abs(tile.most_y)));
}

static inline bool is_longer(TileStreaks a, TileStreaks b) {
  const int la = a.longest_x * a.longest_x + a.longest_y * a.longest_y;
  const int lb = b.longest_x * b.longest_x + b.longest_y * b.longest_y;
  if (la != lb) return la > lb;
  return a.longest_x != b.longest_x ? a.longest_x > b.longest_x : a.longest_y > b.longest_y;
}

__kernel void motion_neighbours(const MotionParams params, __global const TileStreaks* tiles,
                                __global const int* longest, __global TileBlur* blurs) {
  const int tile_x = get_global_id(0);
  const int tile_y = get_global_id(1);
  if (tile_x >= params.tiles_x || tile_y >= params.tiles_y) return;

  const int side = kTileSide * kStreakUnits;
  const int radius = (longest[0] + side - 1) / side;
  TileStreaks all = tiles[tile_y * params.tiles_x + tile_x];
  const int own_reach = reach_of(all);
  for (int y = max(tile_y - radius, 0); y <= min(tile_y + radius, params.tiles_y - 1); ++y) {
    for (int x = max(tile_x - radius, 0); x <= min(tile_x + radius, params.tiles_x - 1); ++x) {
      const TileStreaks other = tiles[y * params.tiles_x + x];
      // From the edge of one tile to the nearest edge of the other.
      const int gap = ((int)max(abs(x - tile_x), abs(y - tile_y)) - 1) * side;
      if (max(own_reach, reach_of(other)) <= gap) continue;
      if (is_longer(other, all)) {
        all.longest_x = other.longest_x;
        all.longest_y = other.longest_y;
      }
      all.least_x = min(all.least_x, other.least_x);
      all.least_y = min(all.least_y, other.least_y);
      all.most_x = max(all.most_x, other.most_x);
      all.most_y = max(all.most_y, other.most_y);
    }
  }
  const int length = (int)max(abs(all.longest_x), abs(all.longest_y));
  int samples_log2 = 2;
  while (samples_log2 < params.most_samples_log2 && (kStreakUnits << samples_log2) < length)
    ++samples_log2;
  const int spread = max(all.most_x - all.least_x, all.most_y - all.least_y);
  TileBlur blur;
  blur.kind = reach_of(all) < STILL ? kTileCopy : spread <= ALIKE ? kTileUniform : kTileMixed;
  blur.samples_log2 = samples_log2;
  blur.x = all.longest_x;
  blur.y = all.longest_y;
  blurs[tile_y * params.tiles_x + tile_x] = blur;
}
