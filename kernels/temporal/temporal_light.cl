// SPDX-License-Identifier: MIT
// temporal_light: whether the light has changed in each tile, from the evidence in it and in the eight tiles around it.
//   relative   sum of brightenings / sum of light: the change of light
//   coherence  |sum of brightenings| / sum of their magnitudes: how far tiles agree
//   gain       the relighting gain: a coherent change that persists for two frames gives 1 + relative; aliased texture
//              changes its sign before that. Where the whole picture changes one way the gain is given at once. Where
//              surfaces move apart a change of light cannot be told from one of surface: the gain is 1, or the whole
//              picture's
//   rejection  the largest of three, clamped to [0, 1]:
//     by error   history foretells the samples much worse than their neighbours do, and not because light has changed
//                or aliasing flickers
//     by cut     over the whole picture history foretells worse than the neighbours: it is another picture
//     by change  the samples of the tile, or of a cell, agree that it is brighter or darker now, by more than its
//                aliasing has shown in flicker and in the neighbours' error, as at the edge of a moving shadow
//   holds back samples that are far brighter than history, or negative, side by side, and the first of late
//              (outliers): gain is 1 and rejection 0 then
//   confirmed  in a rigid tile, around which no suspicion was confirmed lately, rejection by error and by
//              change wait for a second frame, because each place of the jitter can look like a change of its own
//
//   tiles_x, tiles_y  in   how many tiles there are
//   tiles             in   TileReprojection of each tile: motion edges, whether it is rigid, and where it was
//   evidence          in   TileEvidence of each tile
//   total             in   TotalLight: of all tiles
//   previous          in   TileLight of each tile, of the previous frame
//   light             out  TileLight of each tile
// Options: none
// Reference: tests/reference/temporal_light.cpp
#include "temporal/constants.h"
#include "temporal/tile.h"

// The evidence of 3x3 tiles.
typedef struct EvidenceAround {
  TileEvidence sum;
  float change;  // sum of the magnitudes of the brightenings
  float confirmation, recent_outliers;  // the most, in the previous frame
  bool has_motion_edge;
} EvidenceAround;

static inline EvidenceAround sum_evidence(__global const TileReprojection* tiles, __global const TileEvidence* evidence,
                                          __global const TileLight* previous, int tiles_x, int tiles_y, int x, int y) {
  EvidenceAround around = {no_evidence(), 0.0f, 0.0f, 0.0f, false};
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
      around.sum.outliers += tile.outliers;
      around.change += fabs(tile.brightening);
      around.confirmation = max(around.confirmation, previous[i].confirmation);
      around.recent_outliers = max(around.recent_outliers, previous[i].recent_outliers);
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
  change.relative = sum.brightening / max(sum.light, LIGHT_SUM_MIN);
  change.coherence = fabs(sum.brightening) / max(around->change, LIGHT_SUM_MIN);
  change.direction = change.relative > 0.0f ? 1.0f : -1.0f;
  change.is_agreed = sum.brighter * change.direction > RELIGHT_MAJORITY_MIN * sum.count;
  return change;
}

// Returns whether light alone explains it in this frame.
static inline bool is_change_of_light(const LightChange* change, const EvidenceAround* around) {
  return !around->has_motion_edge && change->is_agreed && change->coherence > RELIGHT_COHERENCE_MIN &&
         fabs(change->relative) > RELIGHT_CHANGE_MIN;
}

static inline bool is_relit(const TotalLight* total) {
  const float whole = (float)total->brightening, change = (float)total->change, light = (float)total->light;
  return fabs(whole) > WHOLE_COHERENCE_MIN * change && fabs(whole) > RELIGHT_CHANGE_MIN * light;
}

// Returns how far the mean brightening alternates: the smaller of two frames' whose signs differ.
static inline float alternation(float now, float before) {
  return now * before < 0.0f ? min(fabs(now), fabs(before)) : 0.0f;
}

static inline float suspicion_by_error(const TileEvidence* sum, float flicker) {
  const float usual = ERROR_FLOOR + ERROR_FLICKER * flicker;  // of a sample
  const float allowed = ERROR_RATIO_MIN * sum->neighbour_error + usual * max(sum->count, 1.0f);
  const bool incoherent = fabs(sum->brightening) < ERROR_COHERENCE_MAX * sum->history_error;
  return incoherent ? max((sum->history_error - allowed) / allowed, 0.0f) : 0.0f;
}

static inline float rejection_by_cut(const TotalLight* total) {
  const float error = (float)total->history_error, usual = (float)total->neighbour_error;
  if (!(error > CUT_ERROR_MIN * (float)total->light)) return 0.0f;
  return (error - CUT_RATIO_MIN * usual) / (CUT_RATIO_RANGE * usual + 1.0f);
}

// Returns how much change of a tile or cell is usual.
static inline float usual_change(float neighbour_error, float flicker) {
  return USUAL_NEIGHBOUR_ERROR * neighbour_error + USUAL_FLICKER * flicker + USUAL_CHANGE;
}

// `range`: by how much more than is usual it rejects wholly, as a part of that.
static inline float suspicion_by_change(float mean_brightening, float brighter, float count, float usual,
                                        float range) {
  // A test of signs, corrected as for few samples: three must all agree.
  const float majority = fabs(brighter) - 1.0f;
  const bool is_agreed = majority > 0.0f && majority * majority >= SIGN_TEST_MIN * count;
  return is_agreed ? max((fabs(mean_brightening) - usual) / (range * usual), 0.0f) : 0.0f;
}

// Returns what is left of a suspicion that waits for a second frame: positive if confirmed.
static inline float confirm(float suspected, float before) {
  return max(min(suspected, before) - CONFIRMATION_COST, suspected - SINGLE_FRAME_REJECT_MIN);
}

// The same of a suspicion by change, with its sign, if the previous frame's has it, too.
static inline float confirm_change(float suspected, float before) {
  return confirm(fabs(suspected), suspected * before > 0.0f ? fabs(before) : 0.0f);
}

// What a cell has changed by, and how usual that is. It is not rejected.
static inline CellLight cell_light(CellEvidence evidence, CellLight before, float neighbour_error) {
  CellLight cell;
  cell.rejection = 0.0f;
  cell.mean_brightening = evidence.brightening / max(evidence.count, 1.0f);
  cell.flicker = FLICKER_MEMORY * before.flicker +
                 (1.0f - FLICKER_MEMORY) * alternation(cell.mean_brightening, before.mean_brightening);
  const float usual = usual_change(neighbour_error, cell.flicker);
  cell.suspected_change = copysign(
      suspicion_by_change(cell.mean_brightening, evidence.brighter, evidence.count, usual, CELL_CHANGE_RANGE),
      cell.mean_brightening);
  return cell;
}

// Returns which of `count` tiles or cells in a row, of `size` pixels, the middle of number i was in, `step` texels ago.
static inline int source_of(int i, int size, int step, int count) {
  return clamp(i * size + size / 2 - step, 0, count * size - 1) / size;
}

// Returns what the previous frame remembered of tile (x, y) and of its cells, where a rigid tile was.
static inline TileLight remember(__global const TileLight* previous, TileReprojection tile, int tiles_x, int tiles_y,
                                 int x, int y) {
  const int from_x = source_of(x, kTemporalTile, tile.step_x, tiles_x);
  const int from_y = source_of(y, kTemporalTile, tile.step_y, tiles_y);
  TileLight before = previous[from_y * tiles_x + from_x];
  if (tile.step_x == 0 && tile.step_y == 0) return before;
  for (int c = 0; c < 4; ++c) {
    const int column = source_of(2 * x + c % 2, kTemporalCell, tile.step_x, 2 * tiles_x);
    const int row = source_of(2 * y + c / 2, kTemporalCell, tile.step_y, 2 * tiles_y);
    before.cells[c] = previous[row / 2 * tiles_x + column / 2].cells[row % 2 * 2 + column % 2];
  }
  return before;
}

// That of tile (x, y).
static inline TileLight light_of(int tiles_x, int tiles_y, __global const TileReprojection* tiles,
                                 __global const TileEvidence* evidence, __global const TotalLight* total,
                                 __global const TileLight* previous, int x, int y) {
  const int i = y * tiles_x + x;
  const TileEvidence own = evidence[i];
  const TileLight before = remember(previous, tiles[i], tiles_x, tiles_y, x, y);
  const TotalLight whole = *total;
  const EvidenceAround around = sum_evidence(tiles, evidence, previous, tiles_x, tiles_y, x, y);
  const LightChange change = change_of(&around);
  TileLight tile;

  // Relighting gain.
  const bool changes = is_change_of_light(&change, &around);
  tile.persistence = PERSISTENCE_MEMORY * before.persistence +
                     (changes ? (1.0f - PERSISTENCE_MEMORY) * change.direction : 0.0f);
  float gain = changes && tile.persistence * change.direction > PERSISTENCE_MIN ? 1.0f + change.relative : 1.0f;
  const bool is_widespread = (float)whole.changed > WHOLE_CHANGED_TILES_MIN * (float)(tiles_x * tiles_y);
  const bool relit = is_widespread && is_relit(&whole);
  if (relit && change.is_agreed && change.relative * (float)whole.brightening > 0.0f)
    gain = 1.0f + (float)whole.brightening / (float)whole.light;  // surer than what one tile finds
  tile.gain = clamp(gain, 1.0f / GAIN_MAX, GAIN_MAX);

  // Suspicions. Where the light has changed, a change is none.
  const float mean_error = around.sum.neighbour_error / max(around.sum.count, 1.0f);
  float flicker = 0.0f, sure_of_cells = 0.0f;
  for (int c = 0; c < 4; ++c) {
    tile.cells[c] = cell_light(own.cells[c], before.cells[c], mean_error);
    if (tile.gain != 1.0f) tile.cells[c].suspected_change = 0.0f;
    flicker += 0.25f * tile.cells[c].flicker;
    sure_of_cells =
        max(sure_of_cells, confirm_change(tile.cells[c].suspected_change, before.cells[c].suspected_change));
  }
  const float mean_brightening = own.brightening / max(own.count, 1.0f);
  const float error = suspicion_by_error(&around.sum, flicker);
  const float changed = tile.gain == 1.0f
                            ? suspicion_by_change(mean_brightening, own.brighter, own.count,
                                                  usual_change(mean_error, flicker), TILE_CHANGE_RANGE)
                            : 0.0f;
  tile.suspected_error = error;
  tile.suspected_change = copysign(changed, mean_brightening);
  const float sure_error = confirm(error, before.suspected_error);
  const float sure_change = confirm_change(tile.suspected_change, before.suspected_change);
  tile.confirmation = max(max(sure_error, sure_change), sure_of_cells) > 0.0f
                          ? 1.0f
                          : CONFIRMATION_MEMORY * before.confirmation;

  // Rejection.
  const bool waits = tiles[i].is_rigid && around.confirmation < RIGID_TILE_CONFIRMATION_MAX;
  const float by_error = waits ? sure_error : error;
  const float by_change = waits ? sure_change : changed;
  const float by_cut = is_widespread && !relit ? rejection_by_cut(&whole) : 0.0f;
  const float by_tile = max(max(by_error, by_change), by_cut);
  tile.rejection = 0.0f;
  for (int c = 0; c < 4; ++c) {
    CellLight* cell = &tile.cells[c];
    const float by_cell = waits ? confirm_change(cell->suspected_change, before.cells[c].suspected_change)
                                : fabs(cell->suspected_change);
    cell->rejection = clamp(max(by_tile, by_cell), 0.0f, 1.0f);
    tile.rejection = max(tile.rejection, cell->rejection);
  }
  const float cut = clamp(by_cut, 0.0f, 1.0f);
  tile.cut = max(cut, CUT_MEMORY * before.cut);
  tile.new_cut = max(cut - before.cut, 0.0f);

  // Outliers. Those of a picture that is another one, or in another light, are no faults.
  tile.recent_outliers = around.sum.outliers > 0.0f ? 1.0f : OUTLIER_MEMORY * before.recent_outliers;
  tile.holds_back =
      around.sum.outliers > 0.0f && around.recent_outliers < OUTLIER_REARM_MAX && !relit && !(by_cut > 0.0f);
  if (tile.holds_back) {
    tile.rejection = 0.0f;
    for (int c = 0; c < 4; ++c)
      tile.cells[c].rejection = 0.0f;
    tile.gain = 1.0f;
  }
  return tile;
}

__kernel void temporal_light(int tiles_x, int tiles_y, __global const TileReprojection* tiles,
                             __global const TileEvidence* evidence, __global const TotalLight* total,
                             __global const TileLight* previous, __global TileLight* light) {
  const int y = get_global_id(1);
  if (y >= tiles_y) return;
  for (int x = get_global_id(0); x < tiles_x; x += (int)get_global_size(0))
    light[y * tiles_x + x] = light_of(tiles_x, tiles_y, tiles, evidence, total, previous, x, y);
}
