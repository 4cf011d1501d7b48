// SPDX-License-Identifier: MIT
// temporal_light: judges a change of light in each tile by the evidence in it and in the eight tiles around it.
//   relative   sum of brightenings / sum of light: the change of light
//   coherence  |sum of brightenings| / sum of their magnitudes: how far tiles agree
//   gain       the relighting gain. The broad one follows the light of large parts of the picture: at once if it steps,
//              else by a trend that is learnt, so that history does not lag behind. Instead of it a coherent change
//              here that persists for two frames gives 1 + relative; aliased texture changes its sign before that, and
//              where surfaces move apart a change of light cannot be told from one of surface
//   rejection  of each cell the larger of two, clamped to [0, 1]:
//     judged     by a small network, from the samples of the cell and of the cells and tiles around, now and of late:
//                how far they differ from history, which way, and by how much more than neighbours do, less what the
//                broad gain explains. 0 where another gain is given, and where the cell hardly changes, or by no more
//                than it flickers.
//                In a rigid tile without a recent confirmation around it, this waits for a second frame that says the
//                same: each place of the jitter can look like a change of its own
//     by cut     over the whole picture history predicts worse than the neighbours: it is another picture
//   holds back samples that are far brighter than history, or negative, side by side, and the first of late
//              (outliers): gain is the broad one and rejection 0 then, and cells remember what they did before
//
//   tiles_x, tiles_y  in   the number of tiles
//   tiles             in   TileReprojection of each tile: motion edges, whether it is rigid, and where it was
//   evidence          in   TileEvidence of each tile
//   total             in   TotalLight: of all tiles
//   previous          in   TileLight of each tile, of the previous frame
//   light             out  TileLight of each tile
// Options: none
// Reference: tests/reference/temporal_light.cpp
#include "bits.h"
#include "temporal/constants.h"
#include "temporal/judge_weights.h"
#include "temporal/tile.h"

// The evidence of 3x3 tiles.
typedef struct EvidenceAround {
  float brightening, light, history_error, neighbour_error, count, brighter, outliers;  // sums, as in TileEvidence
  float change;  // sum of the magnitudes of the brightenings
  float confirmation, recent_outliers;  // the most, in the previous frame
  bool has_motion_edge;
} EvidenceAround;

static inline EvidenceAround sum_evidence(__global const TileReprojection* tiles, __global const TileEvidence* evidence,
                                          __global const TileLight* previous, int tiles_x, int tiles_y, int x, int y) {
  float8 sum = (float8)(0.0f);  // of the first fields of TileEvidence
  float2 most = (float2)(0.0f);
  float change = 0.0f;
  int edges = 0;
  for (int row = max(y - 1, 0); row <= min(y + 1, tiles_y - 1); ++row) {
    for (int column = max(x - 1, 0); column <= min(x + 1, tiles_x - 1); ++column) {
      const int i = row * tiles_x + column;
      const float8 tile = vload8(0, &evidence[i].brightening);
      sum += tile;
      change += fabs(tile.s0);
      most = max(most, vload2(0, &previous[i].confirmation));
      edges |= tiles[i].has_motion_edge;
    }
  }
  const EvidenceAround around = {sum.s0, sum.s1, sum.s2, sum.s3, sum.s4, sum.s5, sum.s6, change, most.x, most.y,
                                 edges != 0};
  return around;
}

// A change of light in 3x3 tiles.
typedef struct LightChange {
  float relative, coherence;
  float direction;  // 1: brighter, -1: darker
  bool is_agreed;   // by the samples
} LightChange;

static inline LightChange change_of(const EvidenceAround* around) {
  LightChange change;
  change.relative = around->brightening / max(around->light, LIGHT_SUM_MIN);
  change.coherence = fabs(around->brightening) / max(around->change, LIGHT_SUM_MIN);
  change.direction = change.relative > 0.0f ? 1.0f : -1.0f;
  change.is_agreed = around->brighter * change.direction > RELIGHT_MAJORITY_MIN * around->count;
  return change;
}

// Returns whether light alone explains it in this frame.
static inline bool is_change_of_light(const LightChange* change, const EvidenceAround* around) {
  return !around->has_motion_edge && change->is_agreed && change->coherence > RELIGHT_COHERENCE_MIN &&
         fabs(change->relative) > RELIGHT_CHANGE_MIN;
}

static inline float rejection_by_cut(__global const TotalLight* total) {
  const float error = (float)total->history_error, usual = (float)total->neighbour_error;
  if (!(error > CUT_ERROR_MIN * (float)total->light)) return 0.0f;
  return (error - CUT_RATIO_MIN * usual) / (CUT_RATIO_RANGE * usual + 1.0f);
}

// ---- The broad gain.

// Whether the whole picture is in another light. A few tiles do not make it so, however much they change. Agreement is
// compared without a division: with one, a work-item would have 255 of a GPU's registers.
static inline bool is_relit(__global const TotalLight* total) {
  float lag = 0.0f, lit = 0.0f, usual = 0.0f;
  UNROLL(kLagParts)
  for (int i = 0; i < kLagParts; ++i) {
    lag += (float)total->lags[i].lag;
    lit += (float)total->lags[i].lit;
    usual += (float)total->lags[i].usual_lag;
  }
  return lag * usual > 0.0f && fabs(usual) > WHOLE_AGREEMENT_MIN * USUAL_LAG_MAX * lit &&
         fabs(lag) > RELIGHT_CHANGE_MIN * lit;
}

// Returns the weight of a part of the picture for a place `along` it, in [0, 1], or along a part next to it: a
// quadratic B-spline.
static inline float part_weight(int away, float along) {
  if (away == 0) return 0.5f + along * (1.0f - along);
  return 0.5f * (away < 0 ? (1.0f - along) * (1.0f - along) : along * along);
}

// Returns LagTotal around tile (x, y).
static inline float4 lags_around(__global const LagTotal* lags, int tiles_x, int tiles_y, int x, int y) {
  const int at_x = (2 * x + 1) * kLagColumns, at_y = (2 * y + 1) * kLagRows;
  const int column = at_x / (2 * tiles_x), row = at_y / (2 * tiles_y);
  const float along_x = (float)(at_x % (2 * tiles_x)) / (float)(2 * tiles_x);
  const float along_y = (float)(at_y % (2 * tiles_y)) / (float)(2 * tiles_y);
  float4 sum = (float4)(0.0f);  // as the fields of LagTotal
  for (int j = max(row - 1, 0); j <= min(row + 1, kLagRows - 1); ++j) {
    float4 across = (float4)(0.0f);
    for (int i = max(column - 1, 0); i <= min(column + 1, kLagColumns - 1); ++i)
      across += part_weight(i - column, along_x) * convert_float4(vload4(j * kLagColumns + i, &lags->lag));
    sum += part_weight(j - row, along_y) * across;
  }
  return sum;
}

// Returns how far history lags behind, in parts of its light. What only some tiles show is a change of its own there:
// it counts little. So does a lag that few tiles show, or where they disagree. `units`: of a tile's light.
static inline float lag_of(float4 sum, float units) {
  if (!(sum.x * sum.z > 0.0f)) return 0.0f;
  const float tiles = sum.y / units, square = tiles * tiles;
  const float mean = sum.x / max(sum.y, 1.0f);
  const float agreement = sum.z / (USUAL_LAG_MAX * max(sum.y, 1.0f));
  const float agreed = agreement / LAG_AGREEMENT_MIN, doubt = max(1.0f - agreed * agreed, 0.0f);
  const float without = max(sum.w, LAG_DOUBT * doubt * doubt * sum.y);
  const float usual = sum.z / max(without, units * LAG_TILES / (square * square));
  return fabs(mean) > fabs(usual) ? usual * usual / mean : mean;
}

// Returns the broad gain by LagTotal around a tile, and learns the trend. Without evidence nothing changes.
static inline float follow_light(float4 sum, float units, float* trend) {
  if (!(sum.y > 0.0f)) return 1.0f;
  const float surprise = lag_of(sum, units) - *trend;
  const float change = *trend + clamp(fabs(surprise) / LAG_AT_ONCE, LAG_PART_MIN, 1.0f) * surprise;
  *trend += TREND_PART * clamp(surprise, -TREND_SURPRISE_MAX, TREND_SURPRISE_MAX);
  return fabs(change) > GAIN_CHANGE_MIN ? clamp(1.0f + change, 1.0f / GAIN_MAX, GAIN_MAX) : 1.0f;
}

// ---- Cells.

// A field of four cells.
#define OF_CELLS(cells, field) (float4)((cells)[0].field, (cells)[1].field, (cells)[2].field, (cells)[3].field)

// CellLight of the four cells of a tile.
typedef struct CellLights {
  float4 rejection, mean_brightening, flicker, suspicion, drift;
} CellLights;

static inline CellLight first_cell(const CellLights* cells) {
  const CellLight first = {cells->rejection.x, cells->mean_brightening.x, cells->flicker.x, cells->suspicion.x,
                           cells->drift.x};
  return first;
}

static inline CellLights next_cells(const CellLights* cells) {
  const CellLights next = {cells->rejection.yzwx, cells->mean_brightening.yzwx, cells->flicker.yzwx,
                           cells->suspicion.yzwx, cells->drift.yzwx};
  return next;
}

// The evidence of the tile's four cells and of the twelve around them; none outside the picture.
typedef struct CellsAround {
  float4 brightening, brighter, count;  // sums over the 3x3 cells around each of the four
  float16 means;                        // mean brightenings, row by row
} CellsAround;

// Returns the sums of three in a row around the two in the middle.
static inline float2 sums_of_row(float4 row) {
  return row.s01 + row.s12 + row.s23;
}

// Returns the sums over 3x3 cells around each of the tile's four, by such sums of four rows.
static inline float4 sums_of_rows(const float2* rows) {
  return (float4)(rows[0] + rows[1] + rows[2], rows[1] + rows[2] + rows[3]);
}

// `explained`: of each sample's brightening, by the broad gain.
static inline CellsAround cells_around(__global const TileEvidence* evidence, int tiles_x, int tiles_y, int x, int y,
                                       float explained) {
  float2 brightening[4], brighter[4], count[4];
  float4 means[4];
  UNROLL_ALWAYS(4)
  for (int j = 0; j < 4; ++j) {
    const int row = y + (j + 1) / 2 - 1;
    CellEvidence cells[4];
    UNROLL_ALWAYS(4)
    for (int i = 0; i < 4; ++i) {
      const int column = x + (i + 1) / 2 - 1;
      const CellEvidence none = {0.0f, 0.0f, 0.0f};
      cells[i] = none;
      if (column >= 0 && row >= 0 && column < tiles_x && row < tiles_y)
        cells[i] = evidence[row * tiles_x + column].cells[(j + 1) % 2 * 2 + (i + 1) % 2];
    }
    const float4 counts = OF_CELLS(cells, count);
    const float4 own = OF_CELLS(cells, brightening) - explained * counts;
    brightening[j] = sums_of_row(own);
    brighter[j] = sums_of_row(OF_CELLS(cells, brighter));
    count[j] = sums_of_row(counts);
    means[j] = own / max(counts, 1.0f);
  }
  const CellsAround around = {sums_of_rows(brightening), sums_of_rows(brighter), sums_of_rows(count),
                              (float16)(means[0], means[1], means[2], means[3])};
  return around;
}

// Returns the largest mean of three cells in a row whose middle is each of the tile's four, in four directions, with
// brightenings turned by `direction`: the edge of a shadow is a line.
static inline float4 mean_of_line(float16 means, float4 direction) {
  const float4 one = max((means.s0145 + means.sabef) * direction, (means.s1256 + means.s9ade) * direction);
  const float4 other = max((means.s2367 + means.s89cd) * direction, (means.s4589 + means.s67ab) * direction);
  return (max(one, other) + means.s569a * direction) / 3.0f;
}

// The network's weights, by training (scripts/train_judge.py).
__constant float kInputWeights[JUDGE_INPUTS * JUDGE_HIDDEN] = {JUDGE_INPUT_WEIGHTS};
__constant float kBiases[JUDGE_HIDDEN] = {JUDGE_BIASES};
__constant float kOutputWeights[JUDGE_HIDDEN] = {JUDGE_OUTPUT_WEIGHTS};

static inline float output_of(float16 hidden) {
  const float16 parts = max(hidden, 0.0f) * vload16(0, kOutputWeights);
  const float8 eight = parts.lo + parts.hi;
  const float4 four = eight.lo + eight.hi;
  return four.x + four.y + four.z + four.w + JUDGE_OUTPUT_BIAS;
}

// Returns how far the history of each of four cells is to be rejected, not clamped.
static inline float4 judge(const float4* inputs) {
  const float16 biases = vload16(0, kBiases);
  float16 a = biases, b = biases, c = biases, d = biases;
  UNROLL_LANE(JUDGE_INPUTS)
  for (int i = 0; i < JUDGE_INPUTS; ++i) {
    const float4 input = clamp(inputs[i], -JUDGE_INPUT_MAX, JUDGE_INPUT_MAX);
    const float16 weights = vload16(i, kInputWeights);
    a += input.x * weights;
    b += input.y * weights;
    c += input.z * weights;
    d += input.w * weights;
  }
  return (float4)(output_of(a), output_of(b), output_of(c), output_of(d));
}

// The same of the cells of a tile, by what they say `now` and said before, in a tile of such flicker, and by what the
// tile itself and the 3x3 tiles around say. Whether a cell has become brighter or darker does not matter.
static inline float4 judge_cells(const CellsAround* grid, const CellLights* now, const CellLights* before,
                                 float flicker, __global const TileEvidence* tile, const EvidenceAround* tiles) {
  const float4 mean = now->mean_brightening, own_count = OF_CELLS(tile->cells, count);
  const float4 direction = select((float4)(1.0f), (float4)(-1.0f), mean < 0.0f);
  const float of_tiles = max(tiles->count, 1.0f), usual = tiles->neighbour_error / of_tiles + JUDGE_ERROR_FLOOR;
  const float per_usual = 1.0f / usual, per_sample = per_usual / max(tile->count, 1.0f);
  const float4 per_sample_around = direction / max(grid->count, 1.0f);
  const float4 inputs[JUDGE_INPUTS] = {
      fabs(mean) * per_usual,
      grid->brightening * per_sample_around * per_usual,
      mean_of_line(grid->means, direction) * per_usual,
      direction * before->mean_brightening * per_usual,
      direction * before->drift * per_usual,
      now->flicker * per_usual,
      (float4)(flicker * per_usual),
      (float4)(tile->history_error * per_sample),
      (float4)(tiles->history_error / of_tiles * per_usual),
      direction * OF_CELLS(tile->cells, brighter) / max(own_count, 1.0f),
      grid->brighter * per_sample_around,
      (float4)(usual),
      fabs(mean),
      (float4)(tile->neighbour_error * per_sample),
      own_count,
  };
  return judge(inputs);
}

// What is known of a tile's cells, but for their suspicion and rejection. `explained`: of each sample's brightening, by
// the broad gain.
static inline CellLights cell_lights(__global const CellEvidence* cells, float explained, const CellLights* before) {
  const float4 count = OF_CELLS(cells, count);
  const float4 mean = (OF_CELLS(cells, brightening) - explained * count) / max(count, 1.0f);
  // How far it alternates: the smaller of two frames' whose signs differ.
  const float4 alternation = select((float4)(0.0f), min(fabs(mean), fabs(before->mean_brightening)),
                                    mean * before->mean_brightening < 0.0f);
  CellLights lights;
  lights.mean_brightening = mean;
  lights.flicker = FLICKER_MEMORY * before->flicker + (1.0f - FLICKER_MEMORY) * alternation;
  lights.drift = DRIFT_MEMORY * before->drift + mean;
  return lights;
}

// Returns which of `count` tiles or cells in a row, of `size` pixels, the middle of number i was in, `step` texels ago.
static inline int source_of(int i, int size, int step, int count) {
  return clamp(i * size + size / 2 - step, 0, count * size - 1) / size;
}

// Returns what the previous frame remembered of the cells of tile (x, y), where a rigid tile was.
static inline CellLights remember_cells(__global const TileLight* previous, TileReprojection tile, int tiles_x,
                                        int tiles_y, int x, int y) {
  CellLight cells[4];
  UNROLL_ALWAYS(4)
  for (int c = 0; c < 4; ++c) {
    const int column = source_of(2 * x + c % 2, kTemporalCell, tile.step_x, 2 * tiles_x);
    const int row = source_of(2 * y + c / 2, kTemporalCell, tile.step_y, 2 * tiles_y);
    cells[c] = previous[row / 2 * tiles_x + column / 2].cells[row % 2 * 2 + column % 2];
  }
  const CellLights lights = {OF_CELLS(cells, rejection), OF_CELLS(cells, mean_brightening), OF_CELLS(cells, flicker),
                             OF_CELLS(cells, suspicion), OF_CELLS(cells, drift)};
  return lights;
}

// That of tile (x, y).
static inline TileLight light_of(int tiles_x, int tiles_y, __global const TileReprojection* tiles,
                                 __global const TileEvidence* evidence, __global const TotalLight* total,
                                 __global const TileLight* previous, int x, int y) {
  const int i = y * tiles_x + x;
  __global const TileEvidence* own = evidence + i;
  const TileReprojection way = tiles[i];
  const int from_x = source_of(x, kTemporalTile, way.step_x, tiles_x);
  const int from_y = source_of(y, kTemporalTile, way.step_y, tiles_y);
  const TileLight before = previous[from_y * tiles_x + from_x];
  const CellLights cells_before = remember_cells(previous, way, tiles_x, tiles_y, x, y);
  const EvidenceAround around = sum_evidence(tiles, evidence, previous, tiles_x, tiles_y, x, y);
  const LightChange change = change_of(&around);
  TileLight tile;

  // Relighting gain.
  const bool changes = is_change_of_light(&change, &around);
  tile.persistence = PERSISTENCE_MEMORY * before.persistence +
                     (changes ? (1.0f - PERSISTENCE_MEMORY) * change.direction : 0.0f);
  const bool is_local = changes && tile.persistence * change.direction > PERSISTENCE_MIN;
  tile.trend = previous[i].trend;
  const float4 lags = lags_around(total->lags, tiles_x, tiles_y, x, y);
  const float broad = follow_light(lags, lag_units(tiles_x, tiles_y), &tile.trend);
  tile.gain = is_local ? clamp(1.0f + change.relative, 1.0f / GAIN_MAX, GAIN_MAX) : broad;
  const float explained = (broad - 1.0f) * own->light / max(own->count, 1.0f);
  const bool is_widespread = (float)total->changed > WHOLE_CHANGED_TILES_MIN * (float)(tiles_x * tiles_y);
  const bool relit = is_widespread && is_relit(total);

  // Rejection. Where the light has changed, history follows it.
  CellLights cells = cell_lights(own->cells, explained, &cells_before);
  const float4 flickers = 0.25f * cells.flicker;
  const float flicker = flickers.x + flickers.y + flickers.z + flickers.w;
  const float by_cut = is_widespread && !relit ? rejection_by_cut(total) : 0.0f;
  const bool waits = way.is_rigid && around.confirmation < RIGID_TILE_CONFIRMATION_MAX;
  tile.confirmation = CONFIRMATION_MEMORY * before.confirmation;
  const float4 changed = fabs(cells.mean_brightening);
  const int4 asked =
      (changed > FLICKER_RATIO_MIN * cells.flicker) & (max(changed, fabs(cells.drift)) > JUDGED_CHANGE_MIN);
  float4 judged = (float4)(0.0f);
  if (!is_local && any(asked)) {
    const CellsAround grid = cells_around(evidence, tiles_x, tiles_y, x, y, explained);
    const float4 found = judge_cells(&grid, &cells, &cells_before, flicker, own, &around);
    judged = select((float4)(0.0f), clamp(found, 0.0f, 1.0f), asked);
  }
  cells.suspicion = copysign(judged, cells.mean_brightening);
  const float4 sure = select((float4)(0.0f), max(2.0f * min(judged, fabs(cells_before.suspicion)) - 1.0f, 0.0f),
                             cells.suspicion * cells_before.suspicion > 0.0f);
  if (any(sure > 0.0f)) tile.confirmation = 1.0f;
  cells.rejection = clamp(max(waits ? sure : judged, by_cut), 0.0f, 1.0f);
  const float cut = clamp(by_cut, 0.0f, 1.0f);
  tile.cut = max(cut, CUT_MEMORY * before.cut);
  tile.new_cut = max(cut - before.cut, 0.0f);

  // Outliers. Those of a picture that is another one, or in another light, are no faults.
  tile.recent_outliers = around.outliers > 0.0f ? 1.0f : OUTLIER_MEMORY * before.recent_outliers;
  tile.holds_back =
      around.outliers > 0.0f && around.recent_outliers < OUTLIER_REARM_MAX && !relit && !(by_cut > 0.0f);
  if (tile.holds_back) {
    cells = cells_before;
    cells.rejection = (float4)(0.0f);
    tile.gain = broad;
  }
  const float2 larger = max(cells.rejection.lo, cells.rejection.hi);
  tile.rejection = max(larger.x, larger.y);
  UNROLL_ALWAYS(4)
  for (int c = 0; c < 4; ++c) {
    tile.cells[c] = first_cell(&cells);
    cells = next_cells(&cells);
  }
  return tile;
}

__kernel void temporal_light(int tiles_x, int tiles_y, __global const TileReprojection* tiles,
                             __global const TileEvidence* evidence, __global const TotalLight* total,
                             __global const TileLight* previous, __global TileLight* light) {
  const int y = get_global_id(1);
  if (y >= tiles_y) return;
  // By number: what a row has in common would stay in registers over the loop, 25 of a GPU's.
  for (int i = y * tiles_x + (int)get_global_id(0); i < (y + 1) * tiles_x; i += (int)get_global_size(0))
    light[i] = light_of(tiles_x, tiles_y, tiles, evidence, total, previous, i % tiles_x, i / tiles_x);
}
