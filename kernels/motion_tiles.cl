// SPDX-License-Identifier: MIT
// motion_tiles: finds the streaks of the surfaces in each tile of the output.
//   params    in   extents, layout of velocity, scale from velocity to streaks
//   axes      in   AxisTap of each output column, then of each output row: the samples that pixels see
//   velocity  in   RG16F or RG32F, the viewport of the frame; NaN and Inf count as 0
//   tiles     out  TileStreaks, params.tiles_x x params.tiles_y, row by row
//   longest   out  longest[0] grows to the longest streak of all, on either axis
// Options: SOURCE_STORAGE, VELOCITY_FORMAT as in texel.h
// A tile in which nothing moves by half a pixel on an axis counts as still. Among equally long streaks the one with the
// larger x, then the larger y counts: the order of work does not matter.
// Source: McGuire, Hennessy, Bukowski, Osman, "A Reconstruction Filter for Plausible Motion Blur", 2012.
// Reference: tests/reference/motion_blur.cpp
#include "motion/blur_params.h"
#include "motion/streaks.h"

// Whether no surface of the tile moves by half a pixel on an axis; NaN and Inf do not count as still here.
static inline bool is_still(const MotionParams* params, VELOCITY_TEXELS velocity, int left, int right, int top,
                            int bottom) {
  int8 largest = 0;
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; x += 4) {
      const int4 columns = min((int4)(x, x + 1, x + 2, x + 3), (int4)(right));
      largest = max(largest, as_int8(load_velocity4(velocity, params->velocity, columns, y)) & 0x7fffffff);
    }
  }
  const float8 speed = as_float8(largest);
  const int4 still = (speed.even * fabs(params->scale_x) < (float)(kStreakUnits / 2)) &
                     (speed.odd * fabs(params->scale_y) < (float)(kStreakUnits / 2));
  return all(still);
}

typedef struct Longest {
  int4 length;  // squared
  int4 x;
  int4 y;
} Longest;

static inline void keep_longer(Longest* best, int4 x, int4 y) {
  const int4 length = x * x + y * y;
  const int4 tie = (length == best->length) & ((x > best->x) | ((x == best->x) & (y > best->y)));
  const int4 better = (length > best->length) | tie;
  best->length = select(best->length, length, better);
  best->x = select(best->x, x, better);
  best->y = select(best->y, y, better);
}

__kernel void motion_tiles(const MotionParams params, __global const AxisTap* axes, VELOCITY_TEXELS velocity,
                           __global TileStreaks* tiles, __global int* longest) {
  const int tile_x = get_global_id(0);
  const int tile_y = get_global_id(1);
  if (tile_x >= params.tiles_x || tile_y >= params.tiles_y) return;

  __global const AxisTap* rows = axes + params.row_axis;
  const int left = axes[tile_x * kTileSide].nearest;
  const int right = axes[min(tile_x * kTileSide + kTileSide, params.output_width) - 1].nearest;
  const int top = rows[tile_y * kTileSide].nearest;
  const int bottom = rows[min(tile_y * kTileSide + kTileSide, params.output_height) - 1].nearest;
  if (is_still(&params, velocity, left, right, top, bottom)) {
    const TileStreaks none = {0, 0, 0, 0, 0, 0};
    tiles[tile_y * params.tiles_x + tile_x] = none;
    return;
  }
  Longest best = {(int4)(-1), (int4)(0), (int4)(0)};
  int4 least_x = kLongestStreak;
  int4 least_y = kLongestStreak;
  int4 most_x = -kLongestStreak;
  int4 most_y = -kLongestStreak;
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; x += 4) {
      // At the right edge the last texel stands in for those beyond.
      const int4 columns = min((int4)(x, x + 1, x + 2, x + 3), (int4)(right));
      const float8 moves = load_velocity4(velocity, params.velocity, columns, y);
      const int4 streaks_x = streaks_of_four(moves.even, params.scale_x);
      const int4 streaks_y = streaks_of_four(moves.odd, params.scale_y);
      keep_longer(&best, streaks_x, streaks_y);
      least_x = min(least_x, streaks_x);
      least_y = min(least_y, streaks_y);
      most_x = max(most_x, streaks_x);
      most_y = max(most_y, streaks_y);
    }
  }
  Longest one = {best.length.xxxx, best.x.xxxx, best.y.xxxx};
  keep_longer(&one, best.x.yyyy, best.y.yyyy);
  keep_longer(&one, best.x.zzzz, best.y.zzzz);
  keep_longer(&one, best.x.wwww, best.y.wwww);
  TileStreaks tile;
  tile.longest_x = one.x.s0;
  tile.longest_y = one.y.s0;
  tile.least_x = min(min(least_x.s0, least_x.s1), min(least_x.s2, least_x.s3));
  tile.least_y = min(min(least_y.s0, least_y.s1), min(least_y.s2, least_y.s3));
  tile.most_x = max(max(most_x.s0, most_x.s1), max(most_x.s2, most_x.s3));
  tile.most_y = max(max(most_y.s0, most_y.s1), max(most_y.s2, most_y.s3));
  tiles[tile_y * params.tiles_x + tile_x] = tile;
  atomic_max(longest, (int)max(max(abs(tile.least_x), abs(tile.most_x)), max(abs(tile.least_y), abs(tile.most_y))));
}
