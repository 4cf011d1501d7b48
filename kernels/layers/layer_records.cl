// SPDX-License-Identifier: MIT
// layer_records: finds the samples of near surfaces next to farther ones that move differently.
//   A sample is near if one of its eight neighbours is farther by 3 % of its depth, moves differently by more than
//   .05 output pixels, and the depths are no plane seen at a slant: on the other side of the sample depth rises by no
//   more than half as much.
//   It is thin if no 2x2 block of samples that contains it is near throughout.
//   Its drift is .7 of the change of its motion since the previous frame; 0 where that is more than a quarter of it.
//
//   params            in   viewports, layouts, scales
//   velocity          in   RG16F or RG32F, viewport
//   depth             in   R32F, viewport, reversed
//   open_trust        in   of each sample, from reproject: its sign tells of motion edges
//   previous_keys     in   of the previous frame's grid of records; all zero where there is none
//   previous_records  in   LayerRecord of each of its cells that has one
//   keys              out  of this frame's grid
//   records           out  LayerRecord of each near sample
// Options: SOURCE_STORAGE, VELOCITY_FORMAT as in texel.h
// Reference: tests/reference/layer_records.cpp
#include "layers/records.h"

enum { kTogether = kLanes };  // samples that are looked at together

// Whether the sign of one of `count` trusts, at most one a lane, tells of a motion edge.
static inline bool has_motion_edge(__global const int* trusts, int count) {
#if LANES == 8
  if (count == kLanes) return any_of_eight(vload8(0, trusts) & (int)0x80000000);
#endif
  int all = 0;
  for (int i = 0; i < count; ++i) all |= trusts[i];
  return all < 0;
}

// Whether a sample from (x, y) on may be near: its depth is less than a neighbour's by the gap between layers.
static inline bool may_be_near(const LayerParams* params, DEPTH_TEXELS depth, int x, int y) {
#if SOURCE_STORAGE == BUFFER && LANES == 8
  if (x < 1 || x + kTogether + 1 > params->width) return true;
  LaneFloat least = (LaneFloat)(FLT_MAX), own = least;
  for (int row = max(y - 1, 0); row <= min(y + 1, params->height - 1); ++row) {
    __global const float* line = depth + texel_index(params->depth, x, row);
    const LaneFloat middle = vload8(0, line);
    least = min(min(least, middle), min(vload8(0, line - 1), vload8(0, line + 1)));
    if (row == y) own = middle;
  }
  return any_lane(!(own - least <= LAYER_GAP_MIN * own));
#else
  return true;
#endif
}

static inline bool is_near(const LayerParams* params, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth, Surface own, int x,
                           int y) {
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      const float step = own.depth - depth_at(params, depth, x + column, y + row);
      if (!(step > LAYER_GAP_MIN * own.depth)) continue;
      if (depth_at(params, depth, x - column, y - row) - own.depth > SLANT_RISE_MAX * step) continue;
      const Surface other = surface_at(params, velocity, depth, x + column, y + row);
      if (other.is_known && move_apart(own.motion, other.motion)) return true;
    }
  }
  return false;
}

static inline bool is_thin(const LayerParams* params, DEPTH_TEXELS depth, float own, int x, int y) {
  const float least = own * (1.0f - LAYER_GAP_MIN);
  for (int row = -1; row <= 1; row += 2) {
    for (int column = -1; column <= 1; column += 2) {
      if (depth_at(params, depth, x + column, y) > least && depth_at(params, depth, x, y + row) > least &&
          depth_at(params, depth, x + column, y + row) > least)
        return false;
    }
  }
  return true;
}

// Returns the motion of the same thing in the previous frame, `otherwise` where it has left no record. It comes from
// `place`.
static inline float2 motion_before(const LayerParams* params, __global const uint* keys,
                                   __global const LayerRecord* records, float2 place, float depth, float2 otherwise) {
  const float2 spacing = (float2)(params->previous_spacing_x, params->previous_spacing_y);
  const CellRange around = previous_cells_around(params, place, 1);
  float best = SAME_RECORD_DISTANCE_MAX * SAME_RECORD_DISTANCE_MAX;
  float2 motion = otherwise;
  for (int row = around.first.y; row <= around.last.y; ++row) {
    for (int column = around.first.x; column <= around.last.x; ++column) {
      const int i = row * params->previous_width + column;
      if (keys[i] == 0 || record_age(keys[i]) != 0) continue;
      const LayerRecord record = records[i];
      const float2 apart = ((float2)(record.x, record.y) - place) / spacing;
      const float distance = dot(apart, apart);
      if (!have_one_depth(depth, record.depth) || !(distance < best)) continue;
      best = distance;
      motion = (float2)(record.motion_x, record.motion_y);
    }
  }
  return motion;
}

__kernel void layer_records(const LayerParams params, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth,
                            __global const float* open_trust, __global const uint* previous_keys,
                            __global const LayerRecord* previous_records, __global uint* keys,
                            __global LayerRecord* records) {
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(params.columns_per_item, params.width, kTogether);
  if (item.first >= item.end || y >= params.height) return;

  for (int start = item.first; start < item.end; start += item.step) {
    const int stop = start + min((int)kTogether, pixels_from(item, start));
    __global const int* edges = (__global const int*)open_trust + y * params.width + start;
    for (int x = start; x < stop; ++x) keys[y * params.width + x] = 0;
    if (!has_motion_edge(edges, stop - start) || !may_be_near(&params, depth, start, y)) continue;
    for (int x = start; x < stop; ++x) {
      if (edges[x - start] >= 0) continue;
      const Surface own = surface_at(&params, velocity, depth, x, y);
      if (!own.is_known || !(own.depth > 0.0f) || !is_near(&params, velocity, depth, own, x, y)) continue;

      const int i = y * params.width + x;
      const float2 place = place_of(&params, x, y);
      const float2 before =
          motion_before(&params, previous_keys, previous_records, place + own.motion, own.depth, own.motion);
      float2 drift = DRIFT_SHARE * (own.motion - before);
      if (dot(drift, drift) > DRIFT_MAX * DRIFT_MAX * dot(own.motion, own.motion)) drift = (float2)(0.0f);
      const LayerRecord record = {place.x, place.y, own.depth, own.motion.x, own.motion.y, drift.x, drift.y,
                                  is_thin(&params, depth, own.depth, x, y) ? 1 : 0};
      keys[i] = record_key(0, i);
      records[i] = record;
    }
  }
}
