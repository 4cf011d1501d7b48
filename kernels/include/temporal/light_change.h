// SPDX-License-Identifier: MIT
// Relighting: what the evidence of 3x3 tiles, and of the whole picture, says of a change of light.
#pragma once

#include "temporal/tile.h"

// Thresholds, found by search on the development scenes (docs/temporal.md).
// A change of light in 3x3 tiles.
#define COHERENT 0.75f            // least coherence
#define LEAST_RELIGHT 0.05f       // least change, of the light
#define AGREEING_MAJORITY 0.4f    // (samples for it - samples against it) / samples: seven of ten agree. +.02 dB
#define NOISE_MULTIPLE 3.0f       // least change, in standard deviations of what aliasing alone gives
#define PERSISTENCE_MEMORY 0.6f   // of persistence, from one frame to the next
#define PERSISTENT 0.62f          // least persistence: after two frames it is 1 - .6^2 = .64, after one .4
#define MOST_GAIN 4.0f            // either way
// A change of the whole picture.
#define LEAST_SPREAD 0.2f         // of all tiles have changed: the rest may be black, or alike
// Of its light.
#define WHOLE_COHERENT 0.8f       // least coherence
#define DIFFERENCE_FROM_WHOLE 0.3f  // of the whole picture's change: a tile whose change differs by more keeps its own
#define DIFFERING_COHERENT 0.5f   // least coherence of such a tile

#define SMALLEST_SUM 1e-6f  // keeps 0 / 0 from becoming NaN

// The evidence of 3x3 tiles.
typedef struct EvidenceAround {
  TileEvidence sum;
  float change;  // of the magnitudes of the brightenings
  float unrest, startled;  // the most, in the previous frame
  bool has_motion_edge;
} EvidenceAround;

static inline EvidenceAround sum_evidence(__global const TileReprojection* tiles, __global const TileEvidence* evidence,
                                          __global const TileLight* previous, int tiles_x, int tiles_y, int x, int y) {
  EvidenceAround around = {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}, 0.0f, 0.0f, 0.0f, false};
  for (int row = max(y - 1, 0); row <= min(y + 1, tiles_y - 1); ++row) {
    for (int column = max(x - 1, 0); column <= min(x + 1, tiles_x - 1); ++column) {
      const int i = row * tiles_x + column;
      const TileEvidence tile = evidence[i];
      around.sum.brightening += tile.brightening;
      around.sum.light += tile.light;
      around.sum.history_error += tile.history_error;
      around.sum.neighbour_error += tile.neighbour_error;
      around.sum.count += tile.count;
      around.sum.brighter += tile.brighter;
      around.sum.startling += tile.startling;
      around.change += fabs(tile.brightening);
      around.unrest = max(around.unrest, previous[i].unrest);
      around.startled = max(around.startled, previous[i].startled);
      around.has_motion_edge = around.has_motion_edge || tiles[i].has_motion_edge;
    }
  }
  return around;
}

// A change of light in 3x3 tiles.
typedef struct LightChange {
  float relative, coherence;
  float direction;  // 1: brighter, -1: darker
  bool is_agreed;   // by the samples
} LightChange;

static inline LightChange change_of(const EvidenceAround* around) {
  const TileEvidence sum = around->sum;
  LightChange change;
  change.relative = sum.brightening / max(sum.light, SMALLEST_SUM);
  change.coherence = fabs(sum.brightening) / max(around->change, SMALLEST_SUM);
  change.direction = change.relative > 0.0f ? 1.0f : -1.0f;
  change.is_agreed = sum.brighter * change.direction > AGREEING_MAJORITY * sum.count;
  return change;
}

// Whether nothing else than light explains it in this frame.
static inline bool is_change_of_light(const LightChange* change, const EvidenceAround* around) {
  // What aliasing alone may give.
  const float chance = around->sum.neighbour_error / sqrt(max(around->sum.count, 1.0f));
  return !around->has_motion_edge && change->is_agreed && change->coherence > COHERENT &&
         fabs(change->relative) > LEAST_RELIGHT && fabs(around->sum.brightening) > NOISE_MULTIPLE * chance;
}

static inline bool is_relit(const TotalLight* total) {
  const float whole = (float)total->brightening, change = (float)total->change, light = (float)total->light;
  return fabs(whole) > WHOLE_COHERENT * change && fabs(whole) > LEAST_RELIGHT * light;
}

// The gain of a tile in a picture that is relit: the whole picture's, which is surer than what one tile finds, unless
// the tile's own differs much.
static inline float gain_of_whole(const LightChange* change, const EvidenceAround* around, const TotalLight* total) {
  const float everywhere = (float)total->brightening / (float)total->light;
  const bool differs = !around->has_motion_edge && change->coherence > DIFFERING_COHERENT &&
                       fabs(change->relative - everywhere) > DIFFERENCE_FROM_WHOLE * fabs(everywhere);
  return 1.0f + (differs ? change->relative : everywhere);
}
