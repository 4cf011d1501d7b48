// SPDX-License-Identifier: MIT
// How far history is to be believed, for resolve_temporal: eight output pixels of one row and one tile at a time.
#pragma once

#include "distance_weights.h"
#include "frame_samples.h"
#include "motion_contrast.h"
#include "motion_options.h"

#define NEAREST 1
#define BILINEAR 2
#ifndef TRUST
#define TRUST NEAREST
#endif
#if TRUST != NEAREST && TRUST != BILINEAR
#error "TRUST must be NEAREST or BILINEAR"
#endif

#define HISTORY_SHARPNESS -1.0f     // a of the cubic
#define MOST_CONFIDENCE 32.0f       // about 140 frames at scale .5
#define RESAMPLED_CONFIDENCE 8.0f
#define LEAST_CONFIDENCE 0.15f      // where a Gaussian of this frame begins
#define LEAST_WEIGHT 1e-30f
#define RESAMPLING_COST 0.2f
#define EDGE_COST 4.0f
#define SAME_OFFSET 0.02f           // output pixels
#define FARTHEST_MOVE 65536.0f

// In output pixels, to where the samples' surfaces were.
typedef struct Motion {
  float8 move_x, move_y, trust, contrast;
} Motion;

typedef struct Evidence {
  float8 confidence;
  float8 doubt;  // in [0, 1]: how far history is brought into the range of this frame
} Evidence;

#if MOTION
#if TRUST == BILINEAR
// Of sample (x, y) the trust; NaN is none.
static inline float8 trust_at(__global const float* moves, TexelLayout layout, int8 x, int y) {
  __global const float* row = moves + 4 * row_index(layout, y) + 2;
  const int8 at = 4 * x;
  return fmax((float8)(row[at.s0], row[at.s1], row[at.s2], row[at.s3], row[at.s4], row[at.s5], row[at.s6], row[at.s7]), (float8)(0.0f));
}
#endif

static inline Motion motion_of(const TemporalParams* params, __global const float* moves, Positions now_x, Positions now_y,
                               int8 nearest_x, int nearest_y) {
  __global const float* row = moves + 4 * row_index(params->moves, nearest_y);
  const float4 v0 = vload4(nearest_x.s0, row), v1 = vload4(nearest_x.s1, row), v2 = vload4(nearest_x.s2, row);
  const float4 v3 = vload4(nearest_x.s3, row), v4 = vload4(nearest_x.s4, row), v5 = vload4(nearest_x.s5, row);
  const float4 v6 = vload4(nearest_x.s6, row), v7 = vload4(nearest_x.s7, row);
  Motion motion;
  motion.move_x = (float8)(v0.x, v1.x, v2.x, v3.x, v4.x, v5.x, v6.x, v7.x) * params->move_x;
  motion.move_y = (float8)(v0.y, v1.y, v2.y, v3.y, v4.y, v5.y, v6.y, v7.y) * params->move_y;
  motion.contrast = fabs((float8)(v0.w, v1.w, v2.w, v3.w, v4.w, v5.w, v6.w, v7.w));
#if TRUST == BILINEAR
  const int8 right = min(now_x.texel + 1, (int8)(params->frame0.width - 1));
  const int above = now_y.texel.s0, below = min(above + 1, params->frame0.height - 1);
  const float8 upper = trust_at(moves, params->moves, now_x.texel, above) * (1.0f - now_x.fraction) +
                       trust_at(moves, params->moves, right, above) * now_x.fraction;
  const float8 lower = trust_at(moves, params->moves, now_x.texel, below) * (1.0f - now_x.fraction) +
                       trust_at(moves, params->moves, right, below) * now_x.fraction;
  motion.trust = upper * (1.0f - now_y.fraction) + lower * now_y.fraction;
#else
  motion.trust = fmax((float8)(v0.z, v1.z, v2.z, v3.z, v4.z, v5.z, v6.z, v7.z), (float8)(0.0f));  // NaN is none
#endif
  return motion;
}
#elif REACTIVE
// Where nothing moves.
static inline float8 trust_of_still(const TemporalParams* params, REACTIVE_TEXELS reactive0, REACTIVE_TEXELS reactive1,
                                    int8 nearest_x, int nearest_y) {
  const SourceFrame now = params->frame0, before = params->frame1;
  const float ratio_x = (float)before.width / (float)now.width, ratio_y = (float)before.height / (float)now.height;
  const int8 x = min(convert_int8((convert_float8(nearest_x) + 0.5f) * ratio_x), (int8)(before.width - 1));
  const int y = min((int)(((float)nearest_y + 0.5f) * ratio_y), before.height - 1);
  return (1.0f - (float8)(load_reactive4(reactive0, now.reactive, nearest_x.lo, nearest_y),
                          load_reactive4(reactive0, now.reactive, nearest_x.hi, nearest_y))) *
         (1.0f - (float8)(load_reactive4(reactive1, before.reactive, x.lo, y),
                          load_reactive4(reactive1, before.reactive, x.hi, y)));
}
#endif

// What may be kept with a trust in [0, 1].
static inline float8 most_confidence(float8 trust) {
  return trust / (1.0f + 1.0f / MOST_CONFIDENCE - trust);
}

// Of confidences within [0, MOST_CONFIDENCE], and the fractions of the way between texels at which they were read.
static inline Evidence weigh_history(float8 known, float8 fraction_x, float8 fraction_y, const Motion* motion) {
  const float8 between = min(4.0f * (fraction_x * (1.0f - fraction_x) + fraction_y * (1.0f - fraction_y)), 1.0f);
  float8 w = known / (1.0f + RESAMPLING_COST * between * known);
  w = select(w, min(w, RESAMPLED_CONFIDENCE), between > 0.01f);
  const float8 trust = motion->trust;
  w = min(w, most_confidence(trust));
  w = w / (1.0f + EDGE_COST * smooth_step(motion->contrast, EDGE_COSTS_FROM, EDGE_COSTS_ALL) * w);
  const Evidence evidence = {w, max(1.0f - trust, edge_strength(motion->contrast))};
  return evidence;
}

// Whether the 4x4 texels from (x, y) on lie inside, for all eight pixels.
static inline bool lie_inside(int8 x, int8 y, int width, int height) {
  return !any_lane((x | y | (width - 4 - x) | (height - 4 - y)) >> 31);
}

// On one axis, whether pictures were beyond the edges.
static inline int8 lie_outside(Positions from, int size) {
  const float8 at = convert_float8(from.texel + 1) + from.fraction;
  return (at < -0.5f) | (at > (float)size - 0.5f);
}

static inline bool is_still(TemporalTile tile) {
  return tile.rigid && tile.offset_x == 0.0f && tile.offset_y == 0.0f && tile.step_x == 0 && tile.step_y == 0;
}

// Doubt and gain at the left edge of pixel (x, y), a tile's corner column, between tiles.
static inline float2 change_at(__global const TemporalTile* tiles, const TemporalParams* params, int x, int y) {
  const int right = min(x / kTemporalTile, params->tiles_x - 1), left = max(x / kTemporalTile - 1, 0);
  const int middle = y - kTemporalTile / 2;
  const int above = max(middle, 0) / kTemporalTile, below = min(above + 1, params->tiles_y - 1);
  const float down = middle < 0 ? 0.0f : ((float)(middle % kTemporalTile) + 0.5f) / (float)kTemporalTile;
  __global const TemporalTile* upper = tiles + above * params->tiles_x;
  __global const TemporalTile* lower = tiles + below * params->tiles_x;
  const float2 upper_mean = 0.5f * (float2)(upper[left].doubt + upper[right].doubt, upper[left].gain + upper[right].gain);
  const float2 lower_mean = 0.5f * (float2)(lower[left].doubt + lower[right].doubt, lower[left].gain + lower[right].gain);
  return upper_mean + (lower_mean - upper_mean) * down;
}

// At the centres of a tile's eight columns.
static inline float8 ramp(float left, float right) {
  return left + (right - left) * (float8)(0.0625f, 0.1875f, 0.3125f, 0.4375f, 0.5625f, 0.6875f, 0.8125f, 0.9375f);
}

// The offset of the texels around texel (x, y), which may lie outside.
static inline float2 offset_at(__global const TemporalTile* tiles, const TemporalParams* params, int x, int y) {
  const int tile_x = clamp(x, 0, params->output_width - 1) / kTemporalTile;
  const int tile_y = clamp(y, 0, params->output_height - 1) / kTemporalTile;
  __global const TemporalTile* tile = tiles + tile_y * params->tiles_x + tile_x;
  return (float2)(tile->offset_x, tile->offset_y);
}

// Whether the eight texels from (x, y) on are all there, with the offset that the tile takes.
static inline bool may_copy(__global const TemporalTile* previous, const TemporalParams* params, TemporalTile tile, int x, int y) {
  if (!tile.rigid || x < 0 || y < 0 || x + kTemporalTile > params->output_width || y >= params->output_height) return false;
  const float2 wanted = (float2)(tile.source_x, tile.source_y);
  const float2 left = fabs(offset_at(previous, params, x, y) - wanted);
  const float2 right = fabs(offset_at(previous, params, x + kTemporalTile - 1, y) - wanted);
  return max(max(left.x, left.y), max(right.x, right.y)) <= SAME_OFFSET;
}

// The texel to the upper left of the 4x4 among which each pixel's picture was, and how far between the middle ones.
static inline void source_places(__global const TemporalTile* previous, const TemporalParams* params, TemporalTile tile,
                                 const Motion* motion, int x, int y, Positions* from_x, Positions* from_y) {
  const int8 columns = x + (int8)(0, 1, 2, 3, 4, 5, 6, 7);
  float8 at_x = clamp(motion->move_x, -FARTHEST_MOVE, FARTHEST_MOVE) + tile.offset_x;
  float8 at_y = clamp(motion->move_y, -FARTHEST_MOVE, FARTHEST_MOVE) + tile.offset_y;
  // Less where the texels there have their pictures.
  const int8 i = columns + convert_int8(at_x + 0.5f), j = y + convert_int8(at_y + 0.5f);
  const float2 o0 = offset_at(previous, params, i.s0, j.s0), o1 = offset_at(previous, params, i.s1, j.s1);
  const float2 o2 = offset_at(previous, params, i.s2, j.s2), o3 = offset_at(previous, params, i.s3, j.s3);
  const float2 o4 = offset_at(previous, params, i.s4, j.s4), o5 = offset_at(previous, params, i.s5, j.s5);
  const float2 o6 = offset_at(previous, params, i.s6, j.s6), o7 = offset_at(previous, params, i.s7, j.s7);
  at_x -= (float8)(o0.x, o1.x, o2.x, o3.x, o4.x, o5.x, o6.x, o7.x);
  at_y -= (float8)(o0.y, o1.y, o2.y, o3.y, o4.y, o5.y, o6.y, o7.y);
  int8 whole_x = convert_int8(at_x), whole_y = convert_int8(at_y);
  whole_x += convert_float8(whole_x) > at_x;  // towards minus infinity
  whole_y += convert_float8(whole_y) > at_y;
  from_x->texel = columns + whole_x - 1;
  from_y->texel = y + whole_y - 1;
  from_x->fraction = at_x - convert_float8(whole_x);
  from_y->fraction = at_y - convert_float8(whole_y);
}
