// SPDX-License-Identifier: MIT
// State of the temporal upscaler for each tile of kTemporalTile^2 output pixels, one struct for each owner and
// lifetime:
//
//   struct             written by      read by                                                    lives for
//   TileReprojection   temporal_tiles  temporal_light, resolve_temporal and temporal_display in   two frames
//                                      the same frame, temporal_tiles and resolve_temporal in
//                                      the next
//   TileEvidence       temporal_tiles  temporal_light in the same frame                           one frame
//   TotalLight         temporal_tiles  temporal_light, resolve_layers and display_layers in the   one frame
//                                      same frame
//   TileLight          temporal_light  resolve_temporal in the same frame, temporal_light in the  two frames
//                                      next
//
// Each is an array of the output's tiles, row by row; of TotalLight there is one. A struct that lives for two frames
// has a buffer for each, and the previous frame's is all zero where there is no history.
#pragma once

#include "params.h"

#ifdef __cplusplus
namespace quincunx {
#endif

enum { kTemporalTile = 8 };  // output pixels: as many as resolve_temporal and temporal_display make at once
enum { kTemporalCell = kTemporalTile / 2 };  // output pixels: the side of a cell

// Where a tile's history comes from. In a *rigid* tile everything moves alike. Its texels are copied from the previous
// history by a whole number of texels and never resampled, so that nothing blurs. The rest of the motion is carried
// along as the tile's *phase*: its texels hold the picture at their centres + phase.
typedef struct TileReprojection {
  float phase_x, phase_y;                // output pixels, within [-.5, .5]; 0 if the tile is not rigid
  float source_phase_x, source_phase_y;  // the phase of the previous texels that a rigid tile takes
  int step_x, step_y;                    // texel (x, y) of a rigid tile takes (x - step_x, y - step_y)
  int is_rigid;                          // 0 or 1
  // 0 or 1: rigid, all of its samples are trusted, and there is no motion edge that costs confidence. resolve_temporal
  // copies such a tile without a look at its samples' reprojection (temporal/tile_path.h).
  int is_trusted;
  int has_motion_edge;  // 0 or 1: somewhere in it there is a motion edge, or was one in the previous frame
} TileReprojection;
QUINCUNX_CHECK_SIZE(TileReprojection, 36);

// Whether its history is taken from where it is, with no phase.
static inline bool stands_still(TileReprojection tile) {
  return tile.is_rigid && tile.phase_x == 0.0f && tile.phase_y == 0.0f && tile.step_x == 0 && tile.step_y == 0;
}

// What the samples of a cell, a quarter of a tile, say of history; sums as in TileEvidence.
typedef struct CellEvidence {
  float brightening, brighter, count;
} CellEvidence;

// Evidence of a tile's samples about the history at their places. Sums over its judged samples; s and h are the lumas
// of sample and history, n that of the mean of the four neighbours, and each difference is divided by 1 and both lumas:
// brightness as the eye has it, not light. temporal_light loads the first eight fields at once.
typedef struct TileEvidence {
  float brightening;      // s - h
  float light;            // h
  float history_error;    // |s - h|: history's error as a forecast of the sample
  float neighbour_error;  // |s - n|: the neighbours' error as a forecast of it
  float count;            // number of judged samples
  float brighter;         // how many of them are brighter than history by more than noise, less those that are darker
  float outliers;         // how many of them, with two of their neighbours, are outliers
  float lag, lit;         // s - h and h, each by the sample's luma weight instead: 0 where history is as it comes to be
  CellEvidence cells[4];  // row by row
} TileEvidence;
QUINCUNX_CHECK_SIZE(TileEvidence, 36 + 4 * 12);

// That of no sample.
static inline TileEvidence no_evidence(void) {
  const CellEvidence none = {0.0f, 0.0f, 0.0f};
  const TileEvidence evidence = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, {none, none, none, none}};
  return evidence;
}

// What is to be done about the history of a cell.
typedef struct CellLight {
  float rejection;         // how far history is brought into the range of this frame's samples, in [0, 1]
  float mean_brightening;  // CellEvidence's brightening / count, for the next frame
  float flicker;           // how far that alternates from frame to frame, averaged over frames: aliasing
  float suspicion;         // rejection as this frame alone would have it, with mean_brightening's sign
  float drift;             // sum of mean_brightening over frames, which fades: how far history lagged behind of late
} CellLight;

// Whether the light of a tile has changed, and what is to be done about its history.
typedef struct TileLight {
  float gain;          // the relighting gain: history's light times this is this frame's; 1 where light has not changed
  float rejection;     // the largest of its cells'
  float cut;           // how far the whole picture is another one, in [0, 1], or was of late: it fades over frames
  float new_cut;       // by how much it is that more than of late
  float persistence;   // how far a change of light persists over frames, in [-1, 1]: positive where it brightens
  // These two stand side by side for temporal_light.
  float confirmation;  // 1 in a frame that confirms a suspicion of the previous one; it fades over frames
  float recent_outliers;  // 1 in a frame with outliers in it or beside it; it fades over frames
  // 0 or 1: outliers are held back, because no frame of late had any: they may be faults of one frame.
  int holds_back;
  float trend;  // by how much of the light it changes a frame, as learnt; of the place, not of what moves there
  CellLight cells[4];
} TileLight;
QUINCUNX_CHECK_SIZE(TileLight, 36 + 4 * 20);

// How far the history of a part of the picture lags behind: sums over its tiles, of each in parts of its mean light.
typedef struct LagTotal {
  int lag, lit;
  int usual_lag, usual_lit;  // no tile's lag counts more than usual; light of the tiles that lag less
} LagTotal;
QUINCUNX_CHECK_SIZE(LagTotal, 16);
enum { kLagColumns = 4, kLagRows = 3, kLagParts = kLagColumns * kLagRows };  // parts of the picture

// The evidence of the whole picture, in units of 1 / kLightUnits of a tile's mean, or larger ones where tiles are so
// many that an int would overflow: whether the picture is another one. And how far history lags behind, in its parts.
typedef struct TotalLight {
  int light;
  int history_error, neighbour_error;
  int changed;  // how many tiles have a history_error of more than 3 % of their light
  int layered;  // how many tiles are layered: the entries of their list
  LagTotal lags[kLagParts];  // row by row, in units of 1 / kLagUnits or larger
} TotalLight;
QUINCUNX_CHECK_SIZE(TotalLight, 20 + 16 * kLagParts);
enum { kLightUnits = 2048, kLagUnits = 65536 };

// Units of a tile's light in LagTotal: no sum goes beyond an int, where no lag exceeds LAG_MAX, which is 4.
static inline float lag_units(int tiles_x, int tiles_y) {
  const float most = 0x1p28f / (float)((tiles_x / kLagColumns + 1) * (tiles_y / kLagRows + 1));
  return most < (float)kLagUnits ? most : (float)kLagUnits;
}

#ifdef __cplusplus
}  // namespace quincunx
#endif
