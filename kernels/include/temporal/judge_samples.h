// SPDX-License-Identifier: MIT
// What the samples of a tile say of the history at their places. Eight columns of a row lie in the lanes of a vector:
// the middle six are judged, and the outer two are only their neighbours.
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

enum { kJudgedAtOnce = 6 };  // samples of a row
enum { kHistoryAhead = 4 * kTemporalTile, kColourAhead = 16 };  // texels of history and samples to prefetch

#define LANE_NUMBERS ((int8)(0, 1, 2, 3, 4, 5, 6, 7))

// The lane on the left, and on the right, of each; meaningless in the outermost one.
#define LEFT_LANES(lanes) ((lanes).s70123456)
#define RIGHT_LANES(lanes) NEXT_LANES(lanes)

// The previous frame, as far as it is known, and how to get there.
typedef struct Past {
  __global const float* reprojection;
  HistoryLayer history;
  __global const TileReprojection* previous_tiles;
  __global const LayerSplit* splits;  // one for each sample of a split tile, else null
} Past;

// ---- Rows of samples.

// Returns eight columns from x on, clamped to the viewport's edge.
static inline int8 columns_from(int x, const SourceFrame* frame) {
  return clamp(x + LANE_NUMBERS, (int8)(0), (int8)(frame->width - 1));
}

// Loads the samples from (x, y) on, clamped to the viewport's edge.
static inline SampleLanes load_sample_row(COLOUR_TEXELS colour, const SourceFrame* frame, int x, int y) {
  const int row = clamp(y, 0, frame->height - 1);
  EightTexels texels;
  if (x >= 0 && x + 8 <= frame->width) {
    COLOUR_ROW from = colour_row(colour, frame->colour, row);
    texels.left = load_colour4(colour, from, x);
    texels.right = load_colour4(colour, from, x + 4);
  } else {
    texels = load_samples(colour, frame->colour, columns_from(x, frame), row);
  }
  return compare_lanes(texels);
}

// The four neighbours of each sample of a row.
typedef struct Neighbours {
  SampleLanes left, right, above, below;
} Neighbours;

static inline SampleLanes from_left(const SampleLanes* row) {
  const SampleLanes moved = {LEFT_LANES(row->luma), LEFT_LANES(row->brightest), LEFT_LANES(row->darkest),
                           LEFT_LANES(row->valid)};
  return moved;
}

static inline SampleLanes from_right(const SampleLanes* row) {
  const SampleLanes moved = {RIGHT_LANES(row->luma), RIGHT_LANES(row->brightest), RIGHT_LANES(row->darkest),
                           RIGHT_LANES(row->valid)};
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

// ---- Where they are in history.

#if MOTION
static inline void push_reprojection(EightTexels* found, __global const float* row, int8* x) {
  *found = push_texel(*found, vload4(x->s0, row));
  *x = NEXT_LANES(*x);
}

// Loads Reprojection of the samples at `columns`, which lie side by side from x on unless some are clamped.
static inline EightTexels load_reprojections(const Past* past, const TemporalTileParams* params, int8 columns, int x,
                                             int y) {
  __global const float* row = past->reprojection + 4 * row_index(params->reprojection, y);
  if (x >= 0 && x + 8 <= params->frame.width) {
    const EightTexels found = {vload16(0, row + 4 * x), vload16(0, row + 4 * (x + 4))};
    return found;
  }
  EightTexels found = no_texels();
  EIGHT_TIMES(push_reprojection(&found, row, &columns));
  return found;
}

static inline void subtract_next_phase(const Past* past, const TemporalTileParams* params, float8* at_x,
                                       float8* at_y) {
  const int source = tile_at(params, at_x->s0, at_y->s0);
  at_x->s0 -= past->previous_tiles[source].phase_x;
  at_y->s0 -= past->previous_tiles[source].phase_y;
  *at_x = NEXT_LANES(*at_x);
  *at_y = NEXT_LANES(*at_y);
}
#endif

// Moves eight samples to their places in the previous history, output pixels. Returns which are trusted.
static inline int8 find_in_history(const Past* past, const TemporalTileParams* params, TileReprojection tile,
                                   int8 columns, int x, int y, float8* at_x, float8* at_y) {
  int8 trusted = (int8)(-1);
#if MOTION
  if (!tile.is_trusted) {
    const EightTexels found = load_reprojections(past, params, columns, x, y);
    trusted = blues(found) > JUDGING_TRUST_MIN;
    if (!tile.is_rigid) {
      *at_x += reds(found) * params->motion_x;
      *at_y += greens(found) * params->motion_y;
      EIGHT_TIMES(subtract_next_phase(past, params, at_x, at_y));
    }
  }
#endif
  if (tile.is_rigid) {
    *at_x -= tile.phase_x + (float)tile.step_x;
    *at_y -= tile.phase_y + (float)tile.step_y;
  }
  return trusted;
}

#if LAYERS
// Returns which samples show a near layer, of which the layer of history that is judged knows nothing.
static inline int8 are_of_near_layer(const Past* past, DEPTH_TEXELS depth, TexelLayout layout,
                                     const TemporalTileParams* params, int8 columns, int y) {
  int8 near = (int8)(0);
  for (int lane = 0; lane < 8; ++lane) {
    const LayerSplit split = past->splits[y * params->frame.width + columns.s0];
    near.s0 = is_split(split) && !(load_depth(depth, layout, columns.s0, y) < between_of(split)) ? -1 : 0;
    near = NEXT_LANES(near);
    columns = NEXT_LANES(columns);
  }
  return near;
}
#endif

// ---- Evidence.

// CellEvidence of each lane's samples.
typedef struct CellRows {
  float8 brightening, brighter, count;
} CellRows;

// TileEvidence of each lane's samples; of both rows of cells.
typedef struct TileRowsEvidence {
  CellRows upper, lower;
  float8 light, history_error, neighbour_error, outliers;
} TileRowsEvidence;

static inline TileRowsEvidence no_rows_evidence(void) {
  const float8 none = (float8)(0.0f);
  const CellRows rows = {none, none, none};
  const TileRowsEvidence evidence = {rows, rows, none, none, none, none};
  return evidence;
}

static inline float8 where(int8 lanes, float8 value) {
  return select((float8)(0.0f), value, lanes);
}

// Adds what eight samples say of their history; those that are not `judged` say nothing.
static inline void add_row(TileRowsEvidence* evidence, const TemporalTileParams* params, EightTexels history,
                           const SampleLanes* above, const SampleLanes* own, const SampleLanes* below, int8 judged,
                           bool is_upper) {
  judged &= fabs(confidences(history)) >= JUDGED_CONFIDENCE_MIN;
  const float8 luma = max(own->luma, 0.0f), known = max(luma_of(history), 0.0f);
  const float8 scale = 1.0f / (1.0f + luma + known);
  const float8 change = (luma - known) * scale;
  const float8 one = where(judged, (float8)(1.0f));
  const float8 brighter = where(change > LUMA_CHANGE_MIN, one) - where(change < -LUMA_CHANGE_MIN, one);
  CellRows* rows = is_upper ? &evidence->upper : &evidence->lower;
  rows->brightening += where(judged, change);
  rows->brighter += brighter;
  rows->count += one;
  evidence->light += where(judged, known * scale);
  evidence->history_error += where(judged, fabs(change));

  const Neighbours near = neighbours_of(above, own, below, params->parity >= 0);
  const int8 all_valid = near.left.valid & near.right.valid & near.above.valid & near.below.valid;
  const float8 beside = max(0.25f * (near.left.luma + near.right.luma + near.above.luma + near.below.luma), 0.0f);
  evidence->neighbour_error += where(judged & all_valid, fabs(luma - beside) / (1.0f + luma + beside));

  const OutlierRange range = outlier_range(history);
  const int8 outliers = judged & are_outliers(own, range);
  if (!any_lane(outliers)) return;
  const int8 beside_count = are_outliers(&near.left, range) + are_outliers(&near.right, range) +
                            are_outliers(&near.above, range) + are_outliers(&near.below, range);  // each counts -1
  evidence->outliers += where(outliers & (beside_count <= -2), (float8)(1.0f));
}

static inline float8 add_halves(float8 a, float8 b) {
  return (float8)(a.lo + a.hi, b.lo + b.hi);
}

static inline float8 add_quarters(float8 a, float8 b) {
  return (float8)(a.s0145 + a.s2367, b.s0145 + b.s2367);
}

// Returns the sum of the lanes of each of eight vectors.
static inline float8 sum_lanes(float8 a, float8 b, float8 c, float8 d, float8 e, float8 f, float8 g, float8 h) {
  const float8 abcd = add_quarters(add_halves(a, b), add_halves(c, d));
  const float8 efgh = add_quarters(add_halves(e, f), add_halves(g, h));
  return (float8)(abcd.even + abcd.odd, efgh.even + efgh.odd);
}

static inline void add_to_cell(CellEvidence* cell, float brightening, float brighter, float count) {
  cell->brightening += brightening;
  cell->brighter += brighter;
  cell->count += count;
}

// Adds sums over rows whose lanes at `left` lie in the left cells.
static inline void add_rows(TileEvidence* tile, const TileRowsEvidence* rows, int8 left) {
  const float8 changes = sum_lanes(where(left, rows->upper.brightening), where(~left, rows->upper.brightening),
                                   where(left, rows->lower.brightening), where(~left, rows->lower.brightening),
                                   rows->light, rows->history_error, rows->neighbour_error, rows->outliers);
  const float8 counts = sum_lanes(where(left, rows->upper.brighter), where(~left, rows->upper.brighter),
                                  where(left, rows->lower.brighter), where(~left, rows->lower.brighter),
                                  where(left, rows->upper.count), where(~left, rows->upper.count),
                                  where(left, rows->lower.count), where(~left, rows->lower.count));
  add_to_cell(&tile->cells[0], changes.s0, counts.s0, counts.s4);
  add_to_cell(&tile->cells[1], changes.s1, counts.s1, counts.s5);
  add_to_cell(&tile->cells[2], changes.s2, counts.s2, counts.s6);
  add_to_cell(&tile->cells[3], changes.s3, counts.s3, counts.s7);
  tile->brightening += (changes.s0 + changes.s1) + (changes.s2 + changes.s3);
  tile->light += changes.s4;
  tile->history_error += changes.s5;
  tile->neighbour_error += changes.s6;
  tile->outliers += changes.s7;
  tile->brighter += (counts.s0 + counts.s1) + (counts.s2 + counts.s3);
  tile->count += (counts.s4 + counts.s5) + (counts.s6 + counts.s7);
}

// Judges history by the samples of a tile, at most kJudgedAtOnce columns from column `first` on.
static inline void judge_columns(TileEvidence* evidence, COLOUR_TEXELS colour, DEPTH_TEXELS depth,
                                 TexelLayout depth_layout, const Past* past, const TemporalTileParams* params,
                                 TileReprojection tile, SampleRange samples, int first) {
  const int x = first - 1, width = params->output_width, height = params->output_height;
  const int8 columns = columns_from(x, &params->frame);
  const int8 middle = (LANE_NUMBERS >= 1) & (LANE_NUMBERS <= min(samples.last.x - x, (int)kJudgedAtOnce));
  const float8 place_x = convert_float8(x + LANE_NUMBERS) * params->spacing_x + params->start_x;
  TileRowsEvidence rows = no_rows_evidence();
  SampleLanes above = load_sample_row(colour, &params->frame, x, samples.first.y - 1);
  SampleLanes own = load_sample_row(colour, &params->frame, x, samples.first.y);
  for (int y = samples.first.y; y <= samples.last.y; ++y) {
    will_read_colour(colour, params->frame.colour, x + kColourAhead, y + 1);
    const SampleLanes below = load_sample_row(colour, &params->frame, x, y + 1);
    const float place_y = (float)y * params->spacing_y + params->start_y;
    float8 at_x = place_x, at_y = (float8)(place_y);
    int8 judged = middle & own.valid & find_in_history(past, params, tile, columns, x, y, &at_x, &at_y);
    judged &= (at_x >= 0.0f) & (at_y >= 0.0f) & (at_x < (float)width) & (at_y < (float)height);
    if (params->parity >= 0) judged &= ((columns + y) & 1) == params->parity;
#if LAYERS
    if (past->splits != 0) judged &= ~are_of_near_layer(past, depth, depth_layout, params, columns, y);
#endif
    if (any_lane(judged)) {
      const int8 index = select((int8)(0), convert_int8(at_y) * width + convert_int8(at_x), judged);
      will_read_history(past->history, index.s1 + kHistoryAhead);
      const bool is_upper = (int)place_y % kTemporalTile < kTemporalCell;
      add_row(&rows, params, gather_history(past->history, index), &above, &own, &below, judged, is_upper);
    }
    above = own;
    own = below;
  }
  add_rows(evidence, &rows, convert_int8(place_x) % kTemporalTile < kTemporalCell);
}

// Returns what a tile's samples say of history.
static inline TileEvidence judge_history(COLOUR_TEXELS colour, DEPTH_TEXELS depth, TexelLayout depth_layout,
                                         const Past* past, const TemporalTileParams* params, TileReprojection tile,
                                         SampleRange samples) {
  TileEvidence evidence = no_evidence();
  for (int first = samples.first.x; first <= samples.last.x; first += kJudgedAtOnce)
    judge_columns(&evidence, colour, depth, depth_layout, past, params, tile, samples, first);
  return evidence;
}
