// SPDX-License-Identifier: MIT
// The four ways in which a row of a tile takes history over, from the slowest to the fastest.
//
//   path            the row's eight texels are    its samples are trusted,   the tile's light has not changed, and it
//                   inside and lie as the tile    and none has a motion      holds no samples back; no alpha, no view,
//                   takes them                    edge that costs            no checkerboard
//   kResampled      no                            -                          -
//   kCopied         yes                           no                         -
//   kCopiedTrusted  yes                           yes                        no
//   kCopiedPlain    yes                           yes                        yes
//
//   kResampled      history is read between texels, where each pixel's picture was
//   kCopied         texels are taken as they are, and their confidence is limited by their samples' reprojection
//   kCopiedTrusted  texels are taken with the confidence that they have; their samples' reprojection is not read
//   kCopiedPlain    the same, in a third of the instructions; a row with little known or bright samples is none
// The last two give the same bits.
#pragma once

#include "temporal/constants.h"
#include "temporal/reprojection.h"

typedef enum TilePath { kResampled, kCopied, kCopiedTrusted, kCopiedPlain } TilePath;

// Returns the phase of the previous texels around texel (x, y), clamped to the edge.
static inline float2 phase_at(__global const TileReprojection* tiles, const TemporalParams* params, int x, int y) {
  const int tile_x = clamp(x, 0, params->output_width - 1) / kTemporalTile;
  const int tile_y = clamp(y, 0, params->output_height - 1) / kTemporalTile;
  __global const TileReprojection* tile = tiles + tile_y * params->tiles_x + tile_x;
  return (float2)(tile->phase_x, tile->phase_y);
}

// Returns whether row y of the tile, the tile_x-th of its own row, is copied: it is rigid, and the eight texels that it
// takes are all inside and have the phase that it takes them for.
static inline bool is_copied(__global const TileReprojection* previous, const TemporalParams* params,
                             TileReprojection tile, int tile_x, int y) {
  const int from_x = tile_x * kTemporalTile - tile.step_x, from_y = y - tile.step_y;
  const bool inside = from_x >= 0 && from_y >= 0 && from_x + kTemporalTile <= params->output_width &&
                      from_y < params->output_height;
  if (!tile.is_rigid || !inside) return false;
  const float2 wanted = (float2)(tile.source_phase_x, tile.source_phase_y);
  const float2 left = fabs(phase_at(previous, params, from_x, from_y) - wanted);
  const float2 right = fabs(phase_at(previous, params, from_x + kTemporalTile - 1, from_y) - wanted);
  return max(max(left.x, left.y), max(right.x, right.y)) <= COPIED_PHASE_ERROR_MAX;
}

// Facts that the paths of a tile's rows have in common.
typedef struct TileRows {
  bool are_copied;    // every row is
  bool may_be_plain;  // as the last column of the table above says
} TileRows;

// Returns TileRows for the rows from `first` to `last` of the tile. `is_usual`: its light has not changed, and it holds
// no samples back.
static inline TileRows tile_rows(__global const TileReprojection* previous, const TemporalParams* params,
                                 TileReprojection tile, bool is_usual, int tile_x, int first, int last) {
  const TileRows rows = {
      is_copied(previous, params, tile, tile_x, first) && is_copied(previous, params, tile, tile_x, last),
      is_usual && params->parity < 0 && (tile_x + 1) * kTemporalTile <= params->output_width};
  return rows;
}

// Returns the path of row y of the tile.
static inline TilePath path_of_row(TileRows rows, __global const TileReprojection* previous,
                                   const TemporalParams* params, REACTIVE_TEXELS reactive0, REACTIVE_TEXELS reactive1,
                                   const NearestSamples* nearest, TileReprojection tile, int tile_x,
                                   int y) {
  if (!rows.are_copied && !is_copied(previous, params, tile, tile_x, y)) return kResampled;
  if (!are_trusted(params, reactive0, reactive1, nearest, tile)) return kCopied;
  return rows.may_be_plain ? kCopiedPlain : kCopiedTrusted;
}
