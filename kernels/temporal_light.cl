// SPDX-License-Identifier: MIT
// temporal_light: whether the light has changed in each tile, from what temporal_tiles found in it and the eight around it.
//   relative   sum of brightenings / sum of light; coherence |sum of brightenings| / sum of their magnitudes
//   A coherent change that persists for two frames gives the gain 1 + relative; aliased texture changes its sign before that.
//   Where the whole picture changes one way the gain is given at once.
//   Where surfaces move apart no change of light is told from one of surface: the gain is 1, or the whole picture's.
//   Doubt: history foretells the samples much worse than their neighbours do, and not by a change of light; or over the whole
//   picture as badly, as after a cut; or the tile's own samples agree that it is brighter or darker now, by more than its
//   aliasing has shown in flicker and in neighbours, as in the first frames of a moving highlight.
//
//   tiles_x, tiles_y  in      count
//   previous          in      TemporalTile of each tile, of the previous frame
//   total             in      of all tiles
//   tiles             in out  persistence, flicker, doubt and gain are written
// Reference: tests/reference/temporal_light.cpp
#include "params.h"

#define COHERENT 0.75f       // how far tiles must agree
#define AGREED 0.4f          // of samples: seven of ten say the same
#define RELATIVE 0.05f       // the least change of light
#define PERSISTENT 0.62f     // of two frames: .64
#define MEMORY 0.6f          // of persistence
#define MOST_GAIN 4.0f
#define SURE 3.0f            // times what chance gives
#define WHOLE_COHERENT 0.8f
#define OWN 0.3f             // part by which a tile must differ from the whole to go its own way
#define WORSE 1.6f           // than the neighbours
#define ERROR_FLOOR 0.02f
#define INCOHERENT 0.5f      // part of the error that a change of light may be
#define CUT 0.95f            // of the neighbours' error, over the whole picture; without a cut up to .9
#define CUT_RANGE 0.25f
#define CUT_FLOOR 0.03f      // of the light
#define MAJORITY 1.1f        // of samples that tell of a change: squared standard deviations
#define LEAST_CHANGE 0.15f   // of a tile's light
#define NEIGHBOURS_COUNT 0.8f
#define FLICKER_COUNTS 12.0f  // an aliased tile is more often near its mean than far from it
#define FLICKER_MEMORY 0.9f
#define CHANGE_FLOOR 0.01f
#define CHANGE_RANGE 0.5f

typedef struct Around {
  float brightening, change, light, history_error, neighbour_error, count, brighter;
  bool torn;  // an edge of motion in one of them
} Around;

static inline Around sums_around(__global const TemporalTile* tiles, int tiles_x, int tiles_y, int x, int y) {
  Around sums = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, false};
  for (int row = max(y - 1, 0); row <= min(y + 1, tiles_y - 1); ++row) {
    for (int column = max(x - 1, 0); column <= min(x + 1, tiles_x - 1); ++column) {
      __global const TemporalTile* tile = tiles + row * tiles_x + column;
      sums.brightening += tile->brightening;
      sums.change += fabs(tile->brightening);
      sums.light += tile->light;
      sums.history_error += tile->history_error;
      sums.neighbour_error += tile->neighbour_error;
      sums.count += tile->count;
      sums.brighter += tile->brighter;
      sums.torn = sums.torn || tile->torn;
    }
  }
  return sums;
}

static inline float mean_brightening(__global const TemporalTile* tile) {
  return tile->brightening / max(tile->count, 1.0f);
}

// By how much a sample brightens and darkens in turn.
static inline float reversal(__global const TemporalTile* tile, __global const TemporalTile* earlier) {
  const float now = mean_brightening(tile), before = mean_brightening(earlier);
  return now * before < 0.0f ? min(fabs(now), fabs(before)) : 0.0f;
}

static inline float doubt_of_change(__global const TemporalTile* tile, float neighbour_error) {
  const float majority = fabs(tile->brighter) - 1.0f;  // a test of signs, corrected as for few samples: three must all agree
  const bool agreed = majority > 0.0f && majority * majority >= MAJORITY * tile->count;
  if (!agreed || fabs(tile->brightening) <= LEAST_CHANGE * tile->light) return 0.0f;
  const float usual = NEIGHBOURS_COUNT * neighbour_error + FLICKER_COUNTS * tile->flicker + CHANGE_FLOOR;
  return (fabs(mean_brightening(tile)) - usual) / (CHANGE_RANGE * usual);
}

__kernel void temporal_light(int tiles_x, int tiles_y, __global const TemporalTile* previous, __global const TotalLight* total,
                             __global TemporalTile* tiles) {
  const int x = get_global_id(0), y = get_global_id(1);
  if (x >= tiles_x || y >= tiles_y) return;

  const Around sums = sums_around(tiles, tiles_x, tiles_y, x, y);
  __global TemporalTile* tile = tiles + y * tiles_x + x;
  __global const TemporalTile* earlier = previous + y * tiles_x + x;
  const float relative = sums.brightening / max(sums.light, 1e-6f);
  const float coherence = fabs(sums.brightening) / max(sums.change, 1e-6f);
  const float direction = relative > 0.0f ? 1.0f : -1.0f;
  const float chance = sums.neighbour_error / sqrt(max(sums.count, 1.0f));  // what aliasing alone may give
  const bool agreed = sums.brighter * direction > AGREED * sums.count;
  const bool hit = !sums.torn && agreed && coherence > COHERENT && fabs(relative) > RELATIVE && fabs(sums.brightening) > SURE * chance;
  const float persistence = MEMORY * earlier->persistence + (hit ? (1.0f - MEMORY) * direction : 0.0f);
  float gain = hit && persistence * direction > PERSISTENT ? 1.0f + relative : 1.0f;

  const float whole = (float)total->brightening, change = (float)total->change, light = (float)total->light;
  const bool relit = fabs(whole) > WHOLE_COHERENT * change && fabs(whole) > RELATIVE * light;
  if (relit && agreed && relative * whole > 0.0f) {
    const float everywhere = whole / light;  // surer than what one tile finds, unless that differs much
    const bool own = !sums.torn && coherence > 0.5f && fabs(relative - everywhere) > OWN * fabs(everywhere);
    gain = 1.0f + (own ? relative : everywhere);
  }
  tile->persistence = persistence;
  tile->gain = clamp(gain, 1.0f / MOST_GAIN, MOST_GAIN);

  const float allowed = WORSE * sums.neighbour_error + ERROR_FLOOR;
  const bool incoherent = fabs(sums.brightening) < INCOHERENT * sums.history_error;
  const float here = incoherent ? (sums.history_error - allowed) / allowed : 0.0f;
  tile->flicker = FLICKER_MEMORY * earlier->flicker + (1.0f - FLICKER_MEMORY) * reversal(tile, earlier);
  const float changed = tile->gain == 1.0f ? doubt_of_change(tile, sums.neighbour_error / max(sums.count, 1.0f)) : 0.0f;
  const float error = (float)total->history_error, usual = (float)total->neighbour_error;
  const float cut = !relit && error > CUT_FLOOR * light ? (error - CUT * usual) / (CUT_RANGE * usual + 1.0f) : 0.0f;
  tile->doubt = clamp(max(max(here, changed), cut), 0.0f, 1.0f);
}
