// SPDX-License-Identifier: MIT
// Fetching history: a layer of the previous frame, and its alpha, at output pixels of a row, in one tile.
#pragma once

#include "arithmetic.h"
#include "bits.h"
#include "temporal/constants.h"
#include "temporal/frame_samples.h"
#include "temporal/history_sampling.h"
#include "temporal/tile_path.h"

// ---- Reading between 6x6 texels.

// The cubic is Hermite's, whose slope at each texel comes from two texels on each side. It keeps more of what is
// resampled in each frame than the cubic of 4x4 texels does.
//
// The weights of places on one axis, `fraction` of the way from the third texel to the fourth. The slope at
// texel 0 is LONG_CUBIC_NEAR_SLOPE (t[1] - t[-1]) - LONG_CUBIC_FAR_SLOPE (t[2] - t[-2]).
typedef struct SixWeights {
  LaneFloat w0, w1, w2, w3, w4, w5;
} SixWeights;

static inline SixWeights six_weights(LaneFloat f) {
  const LaneFloat rest = 1.0f - f;
  const LaneFloat before = f * rest * rest, after = -f * f * rest;  // what the slopes at the two texels count
  const LaneFloat next = f * f * (3.0f - 2.0f * f);
  SixWeights w;
  w.w0 = LONG_CUBIC_FAR_SLOPE * before;
  w.w1 = LONG_CUBIC_FAR_SLOPE * after - LONG_CUBIC_NEAR_SLOPE * before;
  w.w2 = 1.0f - next - LONG_CUBIC_NEAR_SLOPE * after;
  w.w3 = next + LONG_CUBIC_NEAR_SLOPE * before;
  w.w4 = LONG_CUBIC_NEAR_SLOPE * after - LONG_CUBIC_FAR_SLOPE * before;
  w.w5 = -LONG_CUBIC_FAR_SLOPE * after;
  return w;
}

// Returns the six weights of the first place, and two that do not count.
static inline float8 first_six(SixWeights w) {
  return (float8)(FIRST_LANE(w.w0), FIRST_LANE(w.w1), FIRST_LANE(w.w2), FIRST_LANE(w.w3), FIRST_LANE(w.w4),
                  FIRST_LANE(w.w5), 0.0f, 0.0f);
}

// Returns the weights with the second place as the first, and the first as the last.
static inline SixWeights next_six(SixWeights w) {
  const SixWeights next = {NEXT_LANES(w.w0), NEXT_LANES(w.w1), NEXT_LANES(w.w2),
                           NEXT_LANES(w.w3), NEXT_LANES(w.w4), NEXT_LANES(w.w5)};
  return next;
}

// Six texels of a row.
typedef struct SixTexels {
  float16 first;  // four
  float8 last;    // two
} SixTexels;

// Loads those from (x, y) on; `inside`: they are there, else they are clamped to the edge.
static inline SixTexels load_six(HistoryLayer layer, int x, int y, bool inside) {
  if (LANES == 8 && inside) {
    const int index = y * layer.width + x;
    const SixTexels row = {load_history4(layer, index), load_history2(layer, index + 4)};
    return row;
  }
  const float16 first = load_clamped4(layer, x, y), last = load_clamped4(layer, x + 4, y);
  const SixTexels row = {first, last.lo};
  return row;
}

static inline void add_six(SixTexels* sum, SixTexels row, float weight) {
  sum->first = MULTIPLY_ADD(row.first, (float16)(weight), sum->first);
  sum->last = MULTIPLY_ADD(row.last, (float8)(weight), sum->last);
}

static inline SixTexels least_of_six(SixTexels a, SixTexels b) {
  const SixTexels least = {min(a.first, b.first), min(a.last, b.last)};
  return least;
}

static inline SixTexels most_of_six(SixTexels a, SixTexels b) {
  const SixTexels most = {max(a.first, b.first), max(a.last, b.last)};
  return most;
}

// Returns history among the 6x6 texels from (x, y) on, held in the range of the middle 4x4.
static inline float4 sample_six(HistoryLayer layer, int x, int y, bool inside, float8 wx, float8 wy) {
  const SixTexels row0 = load_six(layer, x, y, inside), row1 = load_six(layer, x, y + 1, inside);
  const SixTexels row2 = load_six(layer, x, y + 2, inside), row3 = load_six(layer, x, y + 3, inside);
  const SixTexels row4 = load_six(layer, x, y + 4, inside), row5 = load_six(layer, x, y + 5, inside);
  SixTexels sum = {row0.first * wy.s0, row0.last * wy.s0};
  add_six(&sum, row1, wy.s1);
  add_six(&sum, row2, wy.s2);
  add_six(&sum, row3, wy.s3);
  add_six(&sum, row4, wy.s4);
  add_six(&sum, row5, wy.s5);
  const float4 blended = (sum.first.s0123 * wx.s0 + sum.first.s4567 * wx.s1) +
                         (sum.first.s89ab * wx.s2 + sum.first.scdef * wx.s3) +
                         (sum.last.lo * wx.s4 + sum.last.hi * wx.s5);
  const SixTexels least = least_of_six(least_of_six(row1, row2), least_of_six(row3, row4));
  const SixTexels most = most_of_six(most_of_six(row1, row2), most_of_six(row3, row4));
  const float4 low = min(min(least.first.s4567, least.first.s89ab), min(least.first.scdef, least.last.lo));
  const float4 high = max(max(most.first.s4567, most.first.s89ab), max(most.first.scdef, most.last.lo));
  return min(max(blended, low), high);
}

// Returns alpha in the same way, clamped to the edge.
static inline float sample_alpha_six(AlphaPlane plane, int x, int y, float8 wx, float8 wy) {
  float weight[8], sum = 0.0f, low = INFINITY, high = -INFINITY;
  vstore8(wy, 0, weight);
  for (int j = 0; j < 6; ++j) {
    const float4 first = load_alpha_clamped4(plane, x, y + j), last = load_alpha_clamped4(plane, x + 4, y + j);
    sum += weight[j] * (dot(first, wx.lo) + dot(last.lo, wx.s45));
    if (j == 0 || j == 5) continue;
    low = min(low, min(min(first.y, first.z), min(first.w, last.x)));
    high = max(high, max(max(first.y, first.z), max(first.w, last.x)));
  }
  return min(max(sum, low), high);
}

// ---- Fetching.

enum { kResampledAhead = 3 * kTemporalTile };  // texels to prefetch: three blocks further along the row

// History at pixels.
typedef struct FetchedHistory {
  LaneTexels texels;
  LaneFloat confidence;              // within [0, CONFIDENCE_MAX]; 0 from beyond the previous picture's edges
  LaneFloat fraction_x, fraction_y;  // where between texels it was read; 0 where it was copied
} FetchedHistory;

// The phases of the previous texels around texels, clamped to the edge.
typedef struct SourcePhases {
  LaneFloat x, y;
} SourcePhases;

static inline SourcePhases phases_at(__global const TileReprojection* tiles, const TemporalParams* params, LaneInt x,
                                     LaneInt y) {
  const LaneInt last_x = (LaneInt)(params->output_width - 1), last_y = (LaneInt)(params->output_height - 1);
  const LaneUint tile_x = as_lane_uint(clamp(x, (LaneInt)(0), last_x)) / (uint)kTemporalTile;
  const LaneUint tile_y = as_lane_uint(clamp(y, (LaneInt)(0), last_y)) / (uint)kTemporalTile;
  const LaneInt at = as_lane_int(tile_y) * params->tiles_x + as_lane_int(tile_x);
  __global const TileReprojection* first = tiles + FIRST_LANE(at);
  if (!any_lane(at != FIRST_LANE(at))) {  // most often it is one tile
    const SourcePhases one = {(LaneFloat)(first->phase_x), (LaneFloat)(first->phase_y)};
    return one;
  }
  const LaneInt place = (int)(sizeof(TileReprojection) / sizeof(float)) * at;
  const SourcePhases phases = {gather(&tiles->phase_x, place), gather(&tiles->phase_y, place)};
  return phases;
}

// The places of the pictures of pixels in the previous history: on each axis the first of the four texels around
// each place, and the fraction of the way between the middle two.
typedef struct SourcePlaces {
  Positions x, y;
} SourcePlaces;

static inline SourcePlaces source_places(__global const TileReprojection* previous, const TemporalParams* params,
                                         TileReprojection tile, const Reprojections* motion, int x, int y) {
  const LaneInt columns = x + LANE_NUMBERS;
  LaneFloat at_x = clamp(motion->x, -SOURCE_DISTANCE_MAX, SOURCE_DISTANCE_MAX) + tile.phase_x;
  LaneFloat at_y = clamp(motion->y, -SOURCE_DISTANCE_MAX, SOURCE_DISTANCE_MAX) + tile.phase_y;
  // Less the phase of the texels there.
  const LaneInt i = columns + to_lane_int(at_x + 0.5f), j = y + to_lane_int(at_y + 0.5f);
  const SourcePhases phase = phases_at(previous, params, i, j);
  at_x -= phase.x;
  at_y -= phase.y;
  const LaneInt whole_x = floor_lanes(at_x), whole_y = floor_lanes(at_y);
  const SourcePlaces places = {{columns + whole_x - 1, at_x - to_lane_float(whole_x)},
                               {y + whole_y - 1, at_y - to_lane_float(whole_y)}};
  return places;
}

// Returns the texels nearest to places of an axis.
static inline LaneInt nearest_texels(Positions from) {
  return from.texel + select((LaneInt)(1), (LaneInt)(2), from.fraction >= 0.5f);
}

// Returns whether the 4x4 texels from (x, y) on lie inside, for all pixels.
static inline bool lie_inside(LaneInt x, LaneInt y, int width, int height) {
  return !any_lane((x | y | (width - 4 - x) | (height - 4 - y)) < 0);
}

// Returns whether pictures were beyond the edges of one axis.
static inline LaneMask lie_outside(Positions from, int size) {
  const LaneFloat at = to_lane_float(from.texel + 1) + from.fraction;
  return (at < -0.5f) | (at > (float)size - 0.5f);
}

static inline LaneFloat held_confidence(LaneTexels texels) {
  return clamp(confidences(texels), 0.0f, CONFIDENCE_MAX);
}

// A walk over the lanes' places, whose first is the next.
typedef struct CubicWalk {
  LaneInt column, row;
  Cubic x, y;
} CubicWalk;

static inline void walk_on(CubicWalk* at) {
  at->column = NEXT_LANES(at->column);
  at->row = NEXT_LANES(at->row);
  at->x = next_weights(at->x);
  at->y = next_weights(at->y);
}

static inline void sample_next(HistoryLayer layer, bool inside, CubicWalk* at, LaneTexels* sampled) {
  const float4 texel = sample_history(layer, FIRST_LANE(at->column), FIRST_LANE(at->row), inside,
                                      first_weights(at->x), first_weights(at->y));
  *sampled = push_texel(*sampled, texel);
  walk_on(at);
}

// Returns a layer at places with weights x and y, held in the range of the middle four texels. `inside`: all
// texels are.
static inline LaneTexels sample_places(HistoryLayer layer, SourcePlaces from, bool inside, Cubic x, Cubic y) {
  CubicWalk at = {from.x.texel, from.y.texel, x, y};
  LaneTexels sampled = no_texels();
  EACH_LANE(sample_next(layer, inside, &at, &sampled));
  return sampled;
}

#if TAPS == 36
typedef struct SixWalk {
  LaneInt column, row;
  SixWeights x, y;
} SixWalk;

static inline SixWalk walk_between_six(SourcePlaces from) {
  const SixWalk walk = {from.x.texel - 1, from.y.texel - 1, six_weights(from.x.fraction),
                        six_weights(from.y.fraction)};
  return walk;
}

static inline void walk_on_six(SixWalk* at) {
  at->column = NEXT_LANES(at->column);
  at->row = NEXT_LANES(at->row);
  at->x = next_six(at->x);
  at->y = next_six(at->y);
}

static inline void sample_next_six(HistoryLayer layer, bool inside, SixWalk* at, LaneTexels* sampled) {
  const float4 texel =
      sample_six(layer, FIRST_LANE(at->column), FIRST_LANE(at->row), inside, first_six(at->x), first_six(at->y));
  *sampled = push_texel(*sampled, texel);
  walk_on_six(at);
}

// Returns a layer at places between 6x6 texels.
static inline LaneTexels resample_texels(HistoryLayer layer, SourcePlaces from) {
  SixWalk at = walk_between_six(from);
  const bool inside = lie_inside(at.column, at.row, layer.width - 2, layer.height - 2);
  LaneTexels sampled = no_texels();
  EACH_LANE(sample_next_six(layer, inside, &at, &sampled));
  return sampled;
}
#else
// Returns a layer at places between 4x4 texels.
static inline LaneTexels resample_texels(HistoryLayer layer, SourcePlaces from) {
  const bool inside = lie_inside(from.x.texel, from.y.texel, layer.width, layer.height);
  return sample_places(layer, from, inside, cubic_weights(from.x.fraction, HISTORY_SHARPNESS),
                       cubic_weights(from.y.fraction, HISTORY_SHARPNESS));
}
#endif

// Returns history at places, between texels.
static inline FetchedHistory resample_history(HistoryLayer layer, SourcePlaces from) {
  const bool inside = lie_inside(from.x.texel, from.y.texel, layer.width, layer.height);
  will_read_rows(layer, FIRST_LANE(from.x.texel) + kResampledAhead, FIRST_LANE(from.y.texel));
  const LaneTexels texels = resample_texels(layer, from);
  LaneMask outside = mask_of(false);
  if (!inside) outside = lie_outside(from.x, layer.width) | lie_outside(from.y, layer.height);
  const LaneFloat confidence = select(held_confidence(texels), (LaneFloat)(0.0f), outside);
  const FetchedHistory fetched = {texels, confidence, from.x.fraction, from.y.fraction};
  return fetched;
}

// Returns the texels from (x, y) on as they are.
static inline FetchedHistory copy_history(HistoryLayer layer, int x, int y) {
  const LaneTexels texels = load_history_lanes(layer, y * layer.width + x);
  const FetchedHistory fetched = {texels, held_confidence(texels), (LaneFloat)(0.0f), (LaneFloat)(0.0f)};
  return fetched;
}

// Returns a layer at the tile's pixels from (x, y) on.
static inline FetchedHistory fetch_history(HistoryLayer layer, __global const TileReprojection* previous,
                                           const TemporalParams* params, TileReprojection tile, TilePath path,
                                           const Reprojections* motion, int x, int y) {
  if (path != kResampled) return copy_history(layer, x - tile.step_x, y - tile.step_y);
  return resample_history(layer, source_places(previous, params, tile, motion, x, y));
}

// ---- Alpha.

// Returns alpha as resample_history() returns colour.
static inline LaneFloat resample_alpha(AlphaPlane plane, SourcePlaces from) {
  LaneFloat sampled = (LaneFloat)(0.0f);
#if TAPS == 36
  SixWalk at = walk_between_six(from);
  for (int i = 0; i < kLanes; ++i) {
    FIRST_LANE(sampled) =
        sample_alpha_six(plane, FIRST_LANE(at.column), FIRST_LANE(at.row), first_six(at.x), first_six(at.y));
    walk_on_six(&at);
#else
  CubicWalk at = {from.x.texel, from.y.texel, cubic_weights(from.x.fraction, HISTORY_SHARPNESS),
                  cubic_weights(from.y.fraction, HISTORY_SHARPNESS)};
  for (int i = 0; i < kLanes; ++i) {
    FIRST_LANE(sampled) =
        sample_alpha(plane, FIRST_LANE(at.column), FIRST_LANE(at.row), first_weights(at.x), first_weights(at.y));
    walk_on(&at);
#endif
    sampled = NEXT_LANES(sampled);
  }
  return sampled;
}

// Returns alpha as fetch_history() returns colour.
static inline LaneFloat fetch_alpha(AlphaPlane plane, __global const TileReprojection* previous,
                                    const TemporalParams* params, TileReprojection tile, TilePath path,
                                    const Reprojections* motion, int x, int y) {
  if (path != kResampled) return load_alpha_lanes(plane, (y - tile.step_y) * plane.width + x - tile.step_x);
  return resample_alpha(plane, source_places(previous, params, tile, motion, x, y));
}
