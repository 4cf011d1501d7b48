// SPDX-License-Identifier: MIT
// The evidence of tiles' samples about the history at their places. Eight lanes hold columns of two tiles side by side:
// either all eight are judged, and the samples beside them are loaded apart, or the middle six, whose neighbours the
// outer two are. In one lane samples come one by one.
//
// Option: LAYERS  0 (default) | 1: samples of a near layer do not judge
#pragma once

#include "bits.h"
#include "layers/layer.h"
#include "temporal/constants.h"
#include "temporal/frame_samples.h"
#include "temporal/history.h"
#include "temporal/reproject_tile.h"
#include "temporal/temporal_params.h"
#include "texel.h"

#ifndef LAYERS
#define LAYERS 0
#endif

enum { kTilesAtOnce = LANES == 8 ? 2 : 1 };  // side by side

enum { kHistoryAhead = 4 * kTemporalTile, kColourAhead = 16 };  // texels of history and samples to prefetch

// The previous frame, as far as it is known, and how to get there.
typedef struct Past {
  __global const float* reprojection;
  HistoryLayer history;
  __global const TileReprojection* previous_tiles;
  __global const LayerSplit* splits;  // of samples that have two layers
  float change;                       // Exposure's
} Past;

// A tile whose samples are judged.
typedef struct JudgedTile {
  int2 columns;  // of its samples, first and last; none is judged if first > last
  bool is_split;
  TileReprojection reprojection;
} JudgedTile;

// ---- Where samples are in history.

#if MOTION
// Loads the trust of the first lane's sample, and turns to the next.
static inline void load_next_trust(const Past* past, const TemporalTileParams* params, LaneInt* columns, int y,
                                   LaneFloat* trust) {
  FIRST_LANE(*trust) = past->reprojection[4 * texel_index(params->reprojection, FIRST_LANE(*columns), y) + 2];
  *trust = NEXT_LANES(*trust);
  *columns = NEXT_LANES(*columns);
}

// Moves the first lane's place by its sample's motion and the phase of the texels there, and turns to the next.
static inline void follow_next_motion(const Past* past, const TemporalTileParams* params, LaneInt* columns, int y,
                                      LaneFloat* at_x, LaneFloat* at_y) {
  const int sample = 4 * texel_index(params->reprojection, FIRST_LANE(*columns), y);
  const float before_x = FIRST_LANE(*at_x) + past->reprojection[sample] * params->motion_x;
  const float before_y = FIRST_LANE(*at_y) + past->reprojection[sample + 1] * params->motion_y;
  __global const TileReprojection* source = past->previous_tiles + tile_at(params, before_x, before_y);
  FIRST_LANE(*at_x) = before_x - source->phase_x;
  FIRST_LANE(*at_y) = before_y - source->phase_y;
  *at_x = NEXT_LANES(*at_x);
  *at_y = NEXT_LANES(*at_y);
  *columns = NEXT_LANES(*columns);
}
#endif

// How samples get to history.
typedef struct WayBack {
  LaneFloat step_x, step_y;  // of those of rigid tiles, output pixels; else 0
  LaneMask is_rigid, is_trusted;
  bool all_rigid, all_trusted;
  bool any_split;
} WayBack;

static inline WayBack way_back(const JudgedTile* tile) {
  const TileReprojection own = tile->reprojection;
  const WayBack way = {own.is_rigid ? own.phase_x + (float)own.step_x : 0.0f,
                       own.is_rigid ? own.phase_y + (float)own.step_y : 0.0f,
                       mask_of(own.is_rigid),
                       mask_of(own.is_trusted),
                       own.is_rigid,
                       own.is_trusted,
                       tile->is_split};
  return way;
}

// Moves samples of row y to their places in the previous history, output pixels. Returns which are trusted.
static inline LaneMask find_in_history(const Past* past, const TemporalTileParams* params, const WayBack* way,
                                       LaneInt columns, int y, LaneFloat* at_x, LaneFloat* at_y) {
  LaneFloat trust = 1.0f;
#if MOTION
  if (!way->all_trusted) {
    EACH_LANE(load_next_trust(past, params, &columns, y, &trust));
    trust = select(trust, (LaneFloat)(1.0f), way->is_trusted);
  }
  if (!way->all_rigid) {
    LaneFloat moved_x = *at_x, moved_y = *at_y;
    EACH_LANE(follow_next_motion(past, params, &columns, y, &moved_x, &moved_y));
    *at_x = select(moved_x, *at_x, way->is_rigid);
    *at_y = select(moved_y, *at_y, way->is_rigid);
  }
#endif
  *at_x -= way->step_x;
  *at_y -= way->step_y;
  return trust > JUDGING_TRUST_MIN;
}

#if LAYERS
// Whether sample (x, y) has two layers.
static inline bool is_split_at(const TemporalTileParams* params, __global const float* reprojection, int x, int y) {
  return marks_split(reprojection[4 * texel_index(params->reprojection, x, y) + 3]);
}

// Returns which samples show the far layer, or the only one: history that is judged knows nothing of a near one.
static inline LaneMask are_of_far_layer(const Past* past, DEPTH_TEXELS depth, TexelLayout layout,
                                        const TemporalTileParams* params, LaneInt columns, int y) {
  LaneFloat far = 0.0f;
  for (int lane = 0; lane < kLanes; ++lane) {
    const int x = FIRST_LANE(columns);
    const LayerSplit split = past->splits[y * params->frame.width + x];
    const bool is_far = !is_split_at(params, past->reprojection, x, y) ||
                        load_depth(depth, layout, x, y) < between_of(split);
    FIRST_LANE(far) = is_far ? 1.0f : 0.0f;
    far = NEXT_LANES(far);
    columns = NEXT_LANES(columns);
  }
  return far > 0.0f;
}
#endif

// Returns which samples of row y, at these places, may judge history, and the index of the texel of each.
static inline LaneMask find_judged(const Past* past, DEPTH_TEXELS depth, TexelLayout depth_layout,
                                   const TemporalTileParams* params, const WayBack* way, LaneInt columns, int y,
                                   LaneFloat place_x, float place_y, LaneInt* index) {
  const int width = params->output_width, height = params->output_height;
  LaneFloat at_x = place_x, at_y = place_y;
  LaneMask judged = find_in_history(past, params, way, columns, y, &at_x, &at_y);
  judged &= (at_x >= 0.0f) & (at_y >= 0.0f) & (at_x < (float)width) & (at_y < (float)height);
  if (params->parity >= 0) judged &= ((columns + y) & 1) == params->parity;
#if LAYERS
  if (way->any_split) judged &= are_of_far_layer(past, depth, depth_layout, params, columns, y);
#endif
  *index = select((LaneInt)(0), to_lane_int(at_y) * width + to_lane_int(at_x), judged);
  return judged;
}

// ---- Evidence.

// CellEvidence and TileEvidence of each lane's samples, but for outliers.
typedef struct LaneEvidence {
  LaneFloat brightening, brighter, count, light, history_error, neighbour_error, lag, lit;
} LaneEvidence;

static inline LaneFloat where(LaneMask lanes, LaneFloat value) {
  return select((LaneFloat)(0.0f), value, lanes);
}

// Returns what samples say of history by their own luma, history's, and that of their neighbours' mean, which counts
// where all four are valid. What is not `judged` says nothing.
static inline LaneEvidence judge_lanes(LaneFloat own, LaneFloat brightest, LaneFloat known, LaneFloat beside,
                                       LaneMask all_valid, LaneMask judged) {
  const LaneFloat scale = 1.0f / (1.0f + own + known);
  const LaneFloat change = (own - known) * scale;
  LaneEvidence evidence;
  evidence.count = where(judged, (LaneFloat)(1.0f));
  evidence.brightening = where(judged, change);
  evidence.brighter =
      where(change > LUMA_CHANGE_MIN, evidence.count) - where(change < -LUMA_CHANGE_MIN, evidence.count);
  evidence.light = where(judged, known * scale);
  evidence.history_error = where(judged, fabs(change));
  const LaneFloat weight = 1.0f / max(1.0f, 0.5f * brightest);
  evidence.lag = where(judged, (own - known) * weight);
  evidence.lit = where(judged, known * weight);
  evidence.neighbour_error = where(judged & all_valid, fabs(own - beside) / (1.0f + own + beside));
  return evidence;
}

static inline void add_to_cell(CellEvidence* cell, float brightening, float brighter, float count) {
  cell->brightening += brightening;
  cell->brighter += brighter;
  cell->count += count;
}

// The four neighbours of each sample.
typedef struct Neighbours {
  SampleLanes left, right, above, below;
} Neighbours;

#if LANES == 8
// The evidence of rows of tiles, those of upper and of lower cells.
typedef struct RowsEvidence {
  LaneEvidence upper, lower;
  LaneFloat outliers;
} RowsEvidence;

// The samples on the left of the lanes; `beside` has that of the outermost one in its lane 0.
static inline SampleLanes from_left(const SampleLanes* row, const SampleLanes* beside) {
  const SampleLanes moved = {(LaneFloat)(beside->luma.s0, row->luma.s0123, row->luma.s456),
                             (LaneFloat)(beside->brightest.s0, row->brightest.s0123, row->brightest.s456),
                             (LaneFloat)(beside->darkest.s0, row->darkest.s0123, row->darkest.s456),
                             (LaneMask)(beside->valid.s0, row->valid.s0123, row->valid.s456)};
  return moved;
}

// The same on the right; that of the outermost one is in lane 1.
static inline SampleLanes from_right(const SampleLanes* row, const SampleLanes* beside) {
  const SampleLanes moved = {(LaneFloat)(row->luma.s1234, row->luma.s567, beside->luma.s1),
                             (LaneFloat)(row->brightest.s1234, row->brightest.s567, beside->brightest.s1),
                             (LaneFloat)(row->darkest.s1234, row->darkest.s567, beside->darkest.s1),
                             (LaneMask)(row->valid.s1234, row->valid.s567, beside->valid.s1)};
  return moved;
}

// Returns the neighbours that are shaded: on a checkerboard the diagonal ones, but not of the outermost lanes.
static inline Neighbours neighbours_of(const SampleLanes* above, const SampleLanes* own, const SampleLanes* below,
                                       const SampleLanes* beside, bool is_checkerboard) {
  if (is_checkerboard) {
    const Neighbours diagonal = {from_left(above, beside), from_right(above, beside), from_left(below, beside),
                                 from_right(below, beside)};
    return diagonal;
  }
  const Neighbours next = {from_left(own, beside), from_right(own, beside), *above, *below};
  return next;
}

// Loads the samples of row y from column x on; `columns` are the same, and both are clamped to the viewport.
static inline SampleLanes load_row(COLOUR_TEXELS colour, const ExposedFrame* frame, int x, LaneInt columns, int y) {
  const int row = clamp(y, 0, frame->height - 1);
  if (x < 0 || x + kLanes > frame->width) return compare_lanes(load_samples(colour, frame, columns, row));
  COLOUR_ROW from = colour_row(colour, frame->colour, row);
  const LaneTexels texels = {load_colour4(colour, from, x), load_colour4(colour, from, x + 4)};
  return compare_lanes(exposed(texels, frame->exposure));
}

// The rows whose outermost neighbours are loaded together.
enum { kRowsBeside = kLanes / 2 };

// Loads the samples beside the lanes from column x on, of kRowsBeside rows: on the left in even lanes, on the right in
// odd ones.
static inline SampleLanes load_beside(COLOUR_TEXELS colour, const ExposedFrame* frame, int x, int y) {
  const LaneInt columns = x - 1 + (LANE_NUMBERS & 1) * (kLanes + 1), rows = y + LANE_NUMBERS / 2;
  return compare_lanes(load_samples_at(colour, frame, clamp(columns, (LaneInt)(0), (LaneInt)(frame->width - 1)),
                                       min(rows, (LaneInt)(frame->height - 1))));
}

// Those of the next row.
static inline SampleLanes next_beside(const SampleLanes* beside) {
  const SampleLanes next = {beside->luma.s23456701, beside->brightest.s23456701, beside->darkest.s23456701,
                            beside->valid.s23456701};
  return next;
}

// Adds what the samples of a row say.
static inline void add_row(RowsEvidence* rows, LaneTexels history, const SampleLanes* own, const Neighbours* near,
                           LaneMask judged, bool is_upper) {
  judged &= fabs(confidences(history)) >= JUDGED_CONFIDENCE_MIN;
  const LaneFloat beside = 0.25f * (near->left.luma + near->right.luma + near->above.luma + near->below.luma);
  const LaneEvidence found =
      judge_lanes(max(own->luma, 0.0f), own->brightest, max(luma_of(history), 0.0f), max(beside, 0.0f),
                  near->left.valid & near->right.valid & near->above.valid & near->below.valid, judged);
  LaneEvidence* sum = is_upper ? &rows->upper : &rows->lower;
  sum->brightening += found.brightening;
  sum->brighter += found.brighter;
  sum->count += found.count;
  sum->light += found.light;
  sum->history_error += found.history_error;
  sum->neighbour_error += found.neighbour_error;
  sum->lag += found.lag;
  sum->lit += found.lit;
  const OutlierRange range = outlier_range(history);
  const LaneMask outliers = judged & are_outliers(own, range);
  if (!any_lane(outliers)) return;
  const LaneInt beside_count =
      are_outliers(&near->left, range) + are_outliers(&near->right, range) +
      are_outliers(&near->above, range) + are_outliers(&near->below, range);  // each counts -1: these are vectors
  rows->outliers += where(outliers & (beside_count <= -2), (LaneFloat)(1.0f));
}

static inline float8 add_halves(float8 a, float8 b) {
  return (float8)(a.lo + a.hi, b.lo + b.hi);
}

static inline float8 add_quarters(float8 a, float8 b) {
  return (float8)(a.s0145 + a.s2367, b.s0145 + b.s2367);
}

// Returns the sum of the lanes of each of eight vectors.
static inline float8 sum_lanes(float8 a, float8 b, float8 c, float8 d, float8 e, float8 f,
                                  float8 g, float8 h) {
  const float8 abcd = add_quarters(add_halves(a, b), add_halves(c, d));
  const float8 efgh = add_quarters(add_halves(e, f), add_halves(g, h));
  return (float8)(abcd.even + abcd.odd, efgh.even + efgh.odd);
}

// Adds rows whose lanes lie in the tile's left cells or its right ones, or elsewhere.
static inline void add_rows(TileEvidence* tile, const RowsEvidence* rows, LaneMask left, LaneMask right) {
  const LaneEvidence *upper = &rows->upper, *lower = &rows->lower;
  const LaneMask all = left | right;
  const LaneFloat changes =
      sum_lanes(where(left, upper->brightening), where(right, upper->brightening), where(left, lower->brightening),
                where(right, lower->brightening), where(all, upper->light + lower->light),
                where(all, upper->history_error + lower->history_error),
                where(all, upper->neighbour_error + lower->neighbour_error), where(all, rows->outliers));
  const LaneFloat counts = sum_lanes(where(left, upper->brighter), where(right, upper->brighter),
                                  where(left, lower->brighter), where(right, lower->brighter),
                                  where(left, upper->count), where(right, upper->count),
                                  where(left, lower->count), where(right, lower->count));
  const LaneFloat lag = where(all, upper->lag + lower->lag), lit = where(all, upper->lit + lower->lit);
  const float8 two = sum_lanes(lag, lit, lag, lit, lag, lit, lag, lit);
  tile->lag += two.s0;
  tile->lit += two.s1;
  add_to_cell(&tile->cells[0], changes.s0, counts.s0, counts.s4);
  add_to_cell(&tile->cells[1], changes.s1, counts.s1, counts.s5);
  add_to_cell(&tile->cells[2], changes.s2, counts.s2, counts.s6);
  add_to_cell(&tile->cells[3], changes.s3, counts.s3, counts.s7);
  tile->brightening += (changes.s0 + changes.s1) + (changes.s2 + changes.s3);
  tile->brighter += (counts.s0 + counts.s1) + (counts.s2 + counts.s3);
  tile->count += (counts.s4 + counts.s5) + (counts.s6 + counts.s7);
  tile->light += changes.s4;
  tile->history_error += changes.s5;
  tile->neighbour_error += changes.s6;
  tile->outliers += changes.s7;
}

// How samples of two tiles get to history: those at `right` as the second tile's.
static inline WayBack way_back_of_two(const JudgedTile* tiles, LaneMask right) {
  const WayBack a = way_back(tiles), b = way_back(tiles + 1);
  const WayBack way = {select(a.step_x, b.step_x, right),         select(a.step_y, b.step_y, right),
                       select(a.is_rigid, b.is_rigid, right),     select(a.is_trusted, b.is_trusted, right),
                       a.all_rigid && b.all_rigid,                a.all_trusted && b.all_trusted,
                       a.any_split || b.any_split};
  return way;
}

static inline LaneMask are_between(LaneInt columns, int2 range) {
  return (columns >= range.x) & (columns <= range.y);
}

// Adds what two tiles' samples in columns from `first` on say, as far as they lie in those of `left` and of `right`: in
// kLanes of them if it loads the samples beside those, else in two less.
static inline void judge_columns(TileEvidence* evidence, const JudgedTile* tiles, COLOUR_TEXELS colour,
                                 const ExposedFrame* frame, DEPTH_TEXELS depth, TexelLayout depth_layout,
                                 const Past* past, const TemporalTileParams* params, int2 rows, int2 left, int2 right,
                                 int first, bool loads_beside) {
  const int margin = loads_beside ? 0 : 1;
  const int x = first - margin;
  const LaneInt all_columns = x + LANE_NUMBERS;
  const LaneMask middle = (LANE_NUMBERS >= margin) & (LANE_NUMBERS < kLanes - margin);
  const LaneMask of_left = middle & are_between(all_columns, left);
  const LaneMask of_right = middle & are_between(all_columns, right);
  const WayBack way = way_back_of_two(tiles, of_right);
  const LaneInt columns = clamp(all_columns, (LaneInt)(0), (LaneInt)(frame->width - 1));
  const LaneFloat place_x = to_lane_float(all_columns) * params->spacing_x + params->start_x;
  const LaneEvidence none = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
  RowsEvidence sum = {none, none, 0.0f};
  SampleLanes above = load_row(colour, frame, x, columns, rows.x - 1);
  SampleLanes own = load_row(colour, frame, x, columns, rows.x), beside = own;
  for (int y = rows.x; y <= rows.y; ++y) {
    will_read_colour(colour, frame->colour, x + kColourAhead, y + 1);
    const SampleLanes below = load_row(colour, frame, x, columns, y + 1);
    if (loads_beside && (y - rows.x) % kRowsBeside == 0) beside = load_beside(colour, frame, x, y);
    const float place_y = (float)y * params->spacing_y + params->start_y;
    LaneInt index;
    LaneMask judged = find_judged(past, depth, depth_layout, params, &way, columns, y, place_x, place_y, &index);
    judged &= (of_left | of_right) & own.valid;
    if (any_lane(judged)) {
      will_read_history(past->history, index.s1 + kHistoryAhead);
      const Neighbours near = neighbours_of(&above, &own, &below, &beside, params->parity >= 0);
      add_row(&sum, exposed(gather_history(past->history, index), past->change), &own, &near, judged,
              (int)place_y % kTemporalTile < kTemporalCell);
    }
    above = own;
    own = below;
    beside = next_beside(&beside);
  }
  const LaneMask in_left_cells = to_lane_int(place_x) % kTemporalTile < kTemporalCell;
  add_rows(&evidence[0], &sum, of_left & in_left_cells, of_left & mask_not(in_left_cells));
  add_rows(&evidence[1], &sum, of_right & in_left_cells, of_right & mask_not(in_left_cells));
}

// Adds what the samples of two tiles, in the same rows, say of history.
static inline void judge_tiles(TileEvidence* evidence, const JudgedTile* tiles, COLOUR_TEXELS colour,
                               const ExposedFrame* frame, DEPTH_TEXELS depth, TexelLayout depth_layout,
                               const Past* past, const TemporalTileParams* params, int2 rows) {
  const int2 none = (int2)(0, -1);
  const int fewer = kLanes - 2;
  // Where samples are farther apart than tiles, both may have the same, and are judged one by one.
  const bool share = max(tiles[0].columns.x, tiles[1].columns.x) <= min(tiles[0].columns.y, tiles[1].columns.y);
  for (int round = 0; round <= (share ? 1 : 0); ++round) {
    const int2 left = share && round == 1 ? none : tiles[0].columns;
    const int2 right = share && round == 0 ? none : tiles[1].columns;
    const int first = left.x <= left.y ? left.x : right.x, last = max(left.y, right.y), count = last - first + 1;
    const bool loads_beside = params->parity < 0 && (count + kLanes - 1) / kLanes < (count + fewer - 1) / fewer;
    for (int x = first; x <= last; x += loads_beside ? kLanes : fewer)
      judge_columns(evidence, tiles, colour, frame, depth, depth_layout, past, params, rows, left, right, x,
                    loads_beside);
  }
}
#else
// Adds what the tile's samples in column x say.
static inline void judge_column(TileEvidence* evidence, const JudgedTile* tile, COLOUR_TEXELS colour,
                                const ExposedFrame* frame, DEPTH_TEXELS depth, TexelLayout depth_layout,
                                const Past* past, const TemporalTileParams* params, int2 rows, int x) {
  const WayBack way = way_back(tile);
  const int aside = params->parity >= 0 ? 1 : 0;  // the shaded neighbours on a checkerboard are the diagonal ones
  const float place_x = (float)x * params->spacing_x + params->start_x;
  for (int y = rows.x; y <= rows.y; ++y) {
    const float place_y = (float)y * params->spacing_y + params->start_y;
    int index;
    if (!find_judged(past, depth, depth_layout, params, &way, x, y, place_x, place_y, &index)) continue;
    const float4 before = exposed(load_history(past->history, index), past->change);
    const float4 own = sample_at(colour, frame, x, y);
    if (fabs(before.w) < JUDGED_CONFIDENCE_MIN || !is_valid(own)) continue;
    const SampleLanes of_own = compare_lanes(own);
    const Neighbours near = {compare_lanes(sample_at(colour, frame, x - 1, y - aside)),
                             compare_lanes(sample_at(colour, frame, x + 1, y + aside)),
                             compare_lanes(sample_at(colour, frame, x + aside, y - 1)),
                             compare_lanes(sample_at(colour, frame, x - aside, y + 1))};
    const OutlierRange range = outlier_range(before);
    const int outliers_beside = are_outliers(&near.left, range) + are_outliers(&near.right, range) +
                                are_outliers(&near.above, range) + are_outliers(&near.below, range);
    if (are_outliers(&of_own, range) && outliers_beside >= 2) evidence->outliers += 1.0f;
    const float beside = 0.25f * (near.left.luma + near.right.luma + near.above.luma + near.below.luma);
    const bool all_valid = near.left.valid & near.right.valid & near.above.valid & near.below.valid;
    const LaneEvidence found =
        judge_lanes(max(of_own.luma, 0.0f), of_own.brightest, max(luma_of(before), 0.0f), max(beside, 0.0f),
                    all_valid, true);
    evidence->brightening += found.brightening;
    evidence->brighter += found.brighter;
    evidence->count += found.count;
    evidence->light += found.light;
    evidence->history_error += found.history_error;
    evidence->neighbour_error += found.neighbour_error;
    evidence->lag += found.lag;
    evidence->lit += found.lit;
    const int row = (int)place_y % kTemporalTile / kTemporalCell;
    const int column = (int)place_x % kTemporalTile / kTemporalCell;
    UNROLL_ALWAYS(4)  // an index would put the cells on a stack
    for (int cell = 0; cell < 4; ++cell) {
      const bool is_own = cell == 2 * row + column;
      add_to_cell(&evidence->cells[cell], where(is_own, found.brightening), where(is_own, found.brighter),
                  where(is_own, found.count));
    }
  }
}

// Adds what the samples of a tile say of history.
static inline void judge_tiles(TileEvidence* evidence, const JudgedTile* tile, COLOUR_TEXELS colour,
                               const ExposedFrame* frame, DEPTH_TEXELS depth, TexelLayout depth_layout,
                               const Past* past, const TemporalTileParams* params, int2 rows) {
  for (int x = tile->columns.x; x <= tile->columns.y; ++x)
    judge_column(evidence, tile, colour, frame, depth, depth_layout, past, params, rows, x);
}
#endif
