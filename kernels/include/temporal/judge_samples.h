// SPDX-License-Identifier: MIT
// The evidence of a tile's samples about the history at their places. Eight lanes hold eight columns of a
// row: the middle six are judged, and the outer two are only their neighbours. In one lane samples come one by one.
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

enum { kJudgedAtOnce = LANES == 8 ? kLanes - 2 : 1 };  // samples of a row

enum { kHistoryAhead = 4 * kTemporalTile, kColourAhead = 16 };  // texels of history and samples to prefetch

// The previous frame, as far as it is known, and how to get there.
typedef struct Past {
  __global const float* reprojection;
  HistoryLayer history;
  __global const TileReprojection* previous_tiles;
  __global const LayerSplit* splits;  // one for each sample of a split tile, else null
  float change;                       // Exposure's
} Past;

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

// Moves samples of row y to their places in the previous history, output pixels. Returns which are trusted.
static inline LaneMask find_in_history(const Past* past, const TemporalTileParams* params, TileReprojection tile,
                                       LaneInt columns, int y, LaneFloat* at_x, LaneFloat* at_y) {
  LaneFloat trust = 1.0f;
  if (tile.is_rigid) {
    *at_x -= tile.phase_x + (float)tile.step_x;
    *at_y -= tile.phase_y + (float)tile.step_y;
  }
#if MOTION
  if (!tile.is_trusted) EACH_LANE(load_next_trust(past, params, &columns, y, &trust));
  if (!tile.is_rigid) EACH_LANE(follow_next_motion(past, params, &columns, y, at_x, at_y));
#endif
  return trust > JUDGING_TRUST_MIN;
}

#if LAYERS
// Returns which samples show the far layer, or the only one: history that is judged knows nothing of a near one.
static inline LaneMask are_of_far_layer(const Past* past, DEPTH_TEXELS depth, TexelLayout layout,
                                        const TemporalTileParams* params, LaneInt columns, int y) {
  LaneFloat far = 0.0f;
  for (int lane = 0; lane < kLanes; ++lane) {
    const LayerSplit split = past->splits[y * params->frame.width + FIRST_LANE(columns)];
    const bool is_far = !is_split(split) || load_depth(depth, layout, FIRST_LANE(columns), y) < between_of(split);
    FIRST_LANE(far) = is_far ? 1.0f : 0.0f;
    far = NEXT_LANES(far);
    columns = NEXT_LANES(columns);
  }
  return far > 0.0f;
}
#endif

// Returns which samples of row y, at these places, may judge history, and the index of the texel of each.
static inline LaneMask find_judged(const Past* past, DEPTH_TEXELS depth, TexelLayout depth_layout,
                                   const TemporalTileParams* params, TileReprojection tile, LaneInt columns, int y,
                                   LaneFloat place_x, float place_y, LaneInt* index) {
  const int width = params->output_width, height = params->output_height;
  LaneFloat at_x = place_x, at_y = place_y;
  LaneMask judged = find_in_history(past, params, tile, columns, y, &at_x, &at_y);
  judged &= (at_x >= 0.0f) & (at_y >= 0.0f) & (at_x < (float)width) & (at_y < (float)height);
  if (params->parity >= 0) judged &= ((columns + y) & 1) == params->parity;
#if LAYERS
  if (past->splits != 0) judged &= are_of_far_layer(past, depth, depth_layout, params, columns, y);
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
// The evidence of a tile's rows, those of upper and of lower cells.
typedef struct RowsEvidence {
  LaneEvidence upper, lower;
  LaneFloat outliers;
} RowsEvidence;

// The lane on the left of each; meaningless in the outermost one, as in from_right().
static inline SampleLanes from_left(const SampleLanes* row) {
  const SampleLanes moved = {row->luma.s70123456, row->brightest.s70123456, row->darkest.s70123456,
                             row->valid.s70123456};
  return moved;
}

static inline SampleLanes from_right(const SampleLanes* row) {
  const SampleLanes moved = {NEXT_LANES(row->luma), NEXT_LANES(row->brightest), NEXT_LANES(row->darkest),
                             NEXT_LANES(row->valid)};
  return moved;
}

// Returns the neighbours that are shaded: on a checkerboard the diagonal ones.
static inline Neighbours neighbours_of(const SampleLanes* above, const SampleLanes* own, const SampleLanes* below,
                                       bool is_checkerboard) {
  if (is_checkerboard) {
    const Neighbours diagonal = {from_left(above), from_right(above), from_left(below), from_right(below)};
    return diagonal;
  }
  const Neighbours beside = {from_left(own), from_right(own), *above, *below};
  return beside;
}

// Loads the samples of row y from column x on; `columns` are the same, and both are clamped to the viewport.
static inline SampleLanes load_row(COLOUR_TEXELS colour, const ExposedFrame* frame, int x, LaneInt columns, int y) {
  const int row = clamp(y, 0, frame->height - 1);
  if (x < 0 || x + kLanes > frame->width) return compare_lanes(load_samples(colour, frame, columns, row));
  COLOUR_ROW from = colour_row(colour, frame->colour, row);
  const LaneTexels texels = {load_colour4(colour, from, x), load_colour4(colour, from, x + 4)};
  return compare_lanes(exposed(texels, frame->exposure));
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

// Adds rows whose lanes at `left` lie in the left cells.
static inline void add_rows(TileEvidence* tile, const RowsEvidence* rows, LaneMask left) {
  const LaneEvidence *upper = &rows->upper, *lower = &rows->lower;
  const LaneMask right = mask_not(left);
  const LaneFloat changes =
      sum_lanes(where(left, upper->brightening), where(right, upper->brightening), where(left, lower->brightening),
                where(right, lower->brightening), upper->light + lower->light,
                upper->history_error + lower->history_error, upper->neighbour_error + lower->neighbour_error,
                rows->outliers);
  const LaneFloat counts = sum_lanes(where(left, upper->brighter), where(right, upper->brighter),
                                  where(left, lower->brighter), where(right, lower->brighter),
                                  where(left, upper->count), where(right, upper->count),
                                  where(left, lower->count), where(right, lower->count));
  const LaneFloat lag = upper->lag + lower->lag, lit = upper->lit + lower->lit;
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

// Adds what the tile's samples in at most kJudgedAtOnce columns from `first` on say.
static inline void judge_columns(TileEvidence* evidence, COLOUR_TEXELS colour, const ExposedFrame* frame,
                                 DEPTH_TEXELS depth, TexelLayout depth_layout, const Past* past,
                                 const TemporalTileParams* params, TileReprojection tile, SampleRange samples,
                                 int first) {
  const int x = first - 1;  // the left neighbour
  const LaneInt columns = clamp(x + LANE_NUMBERS, (LaneInt)(0), (LaneInt)(frame->width - 1));
  const LaneMask middle = (LANE_NUMBERS >= 1) & (LANE_NUMBERS <= min(samples.last.x - x, (int)kJudgedAtOnce));
  const LaneFloat place_x = to_lane_float(x + LANE_NUMBERS) * params->spacing_x + params->start_x;
  const LaneEvidence none = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
  RowsEvidence rows = {none, none, 0.0f};
  SampleLanes above = load_row(colour, frame, x, columns, samples.first.y - 1);
  SampleLanes own = load_row(colour, frame, x, columns, samples.first.y);
  for (int y = samples.first.y; y <= samples.last.y; ++y) {
    will_read_colour(colour, frame->colour, x + kColourAhead, y + 1);
    const SampleLanes below = load_row(colour, frame, x, columns, y + 1);
    const float place_y = (float)y * params->spacing_y + params->start_y;
    LaneInt index;
    LaneMask judged = find_judged(past, depth, depth_layout, params, tile, columns, y, place_x, place_y, &index);
    judged &= middle & own.valid;
    if (any_lane(judged)) {
      will_read_history(past->history, index.s1 + kHistoryAhead);
      const Neighbours near = neighbours_of(&above, &own, &below, params->parity >= 0);
      add_row(&rows, exposed(gather_history(past->history, index), past->change), &own, &near, judged,
              (int)place_y % kTemporalTile < kTemporalCell);
    }
    above = own;
    own = below;
  }
  add_rows(evidence, &rows, to_lane_int(place_x) % kTemporalTile < kTemporalCell);
}
#else
// Adds what the tile's samples in column x say.
static inline void judge_columns(TileEvidence* evidence, COLOUR_TEXELS colour, const ExposedFrame* frame,
                                 DEPTH_TEXELS depth, TexelLayout depth_layout, const Past* past,
                                 const TemporalTileParams* params, TileReprojection tile, SampleRange samples, int x) {
  const int aside = params->parity >= 0 ? 1 : 0;  // the shaded neighbours on a checkerboard are the diagonal ones
  const float place_x = (float)x * params->spacing_x + params->start_x;
  for (int y = samples.first.y; y <= samples.last.y; ++y) {
    const float place_y = (float)y * params->spacing_y + params->start_y;
    int index;
    if (!find_judged(past, depth, depth_layout, params, tile, x, y, place_x, place_y, &index)) continue;
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
#endif

// Returns what a tile's samples say of history.
static inline TileEvidence judge_history(COLOUR_TEXELS colour, const ExposedFrame* frame, DEPTH_TEXELS depth,
                                         TexelLayout depth_layout, const Past* past, const TemporalTileParams* params,
                                         TileReprojection tile, SampleRange samples) {
  TileEvidence evidence = no_evidence();
  for (int first = samples.first.x; first <= samples.last.x; first += kJudgedAtOnce)
    judge_columns(&evidence, colour, frame, depth, depth_layout, past, params, tile, samples, first);
  return evidence;
}
