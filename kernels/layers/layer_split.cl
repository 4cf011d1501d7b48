// SPDX-License-Identifier: MIT
// layer_split: finds the samples that have two layers. With r the record within 1.7 samples of a sample whose squared
// distance + .4 of its age is least, and b the closest of its 3x3 samples that lies behind r by 3 % of depth, the
// sample is split if the two move apart. Its reprojection becomes that of the far layer: a near sample takes b's.
//   If r is new, and no record of the previous frame lies around the place that it comes from, the two have only begun
//   to move apart: history there holds both, and open trust is low.
//
//   params            in      viewports, layouts, scales
//   velocity          in      RG16F or RG32F, viewport
//   depth             in      R32F, viewport
//   open_trust        in/out  of each sample: trust without a comparison of depths, as reproject signs it; lowered
//                             ones have no sign
//   previous_keys     in      of the previous frame's grid of records
//   keys              in      of this frame's grid of records
//   previous_records  in      LayerRecord of each cell of the previous grid that has one
//   records           in/out  LayerRecord of each near sample; grows by those that came from the previous frame
//   reprojection      in/out  Reprojection of each sample: of split ones the far layer's, which tells that they are
//   splits            out     LayerSplit of each split sample
//   marks             out     of each tile: not 0 if a sample in it is split. All zero before
// Options: SOURCE_STORAGE, VELOCITY_FORMAT as in texel.h
// Reference: tests/reference/layer_split.cpp
#include "layers/records.h"

enum {
  kReach = 2,  // cells around a sample that may hold its record: that lies within half a sample of its cell's centre
  kWindow = kLanes  // samples of a row that are looked at together
};

static inline LayerRecord record_of(uint key, int cell, __global const LayerRecord* previous_records,
                                    __global const LayerRecord* records) {
  return record_age(key) == 0 ? records[cell] : advanced(previous_records[record_index(key)]);
}

// Whether a cell within reach of the samples from (x, y) on has a record.
static inline bool has_record_near(const LayerParams* params, __global const uint* keys, int x, int y) {
  const int left = max(x - kReach, 0), right = min(x + kWindow + kReach, params->width);
  const int first = max(y - kReach, 0), last = min(y + kReach, params->height - 1);
#if LANES == 8
  if (right - left == kWindow + 2 * kReach) {
    uint8 any = 0;
    for (int row = first; row <= last; ++row) {
      __global const uint* line = keys + row * params->width + left;
      any |= vload8(0, line) | vload8(0, line + 2 * kReach);
    }
    return any_of_eight(as_int8(any));
  }
#endif
  uint any = 0;
  for (int row = first; row <= last; ++row) {
    for (int column = left; column < right; ++column) any |= keys[row * params->width + column];
  }
  return any != 0;
}

// The cell of the record of each of some samples of a row; -1 if none is within reach.
typedef struct NearestRecords {
  int cell[kLanes];
} NearestRecords;

// Returns where a cell's record lies, counted in samples. A new one is exactly at its cell's sample.
static inline float2 record_position(const LayerParams* params, uint key, int column, int row,
                                     __global const LayerRecord* previous_records) {
  if (record_age(key) == 0) return (float2)((float)column, (float)row);
  const LayerRecord record = advanced(previous_records[record_index(key)]);
  return among_samples(params, (float2)(record.x, record.y));
}

// Finds the records nearest to the samples from (x, y) on, old ones as if they were farther; of two alike the first.
static inline NearestRecords find_records(const LayerParams* params, __global const uint* keys,
                                          __global const LayerRecord* previous_records, int x, int y) {
  const LaneFloat sample_x = to_lane_float(x + LANE_NUMBERS);
  const float sample_y = (float)y;
  LaneFloat best = (LaneFloat)(FLT_MAX);
  LaneInt cells = (LaneInt)(-1);
  for (int row = max(y - kReach, 0); row <= min(y + kReach, params->height - 1); ++row) {
    for (int column = max(x - kReach, 0); column < min(x + kWindow + kReach, params->width); ++column) {
      const int cell = row * params->width + column;
      const uint key = keys[cell];
      if (key == 0) continue;
      const float2 position = record_position(params, key, column, row, previous_records);
      const LaneFloat apart_x = position.x - sample_x;
      const float apart_y = position.y - sample_y;
      const LaneFloat distance = apart_x * apart_x + apart_y * apart_y;
      const LaneFloat cost = distance + RECORD_AGE_COST * (float)record_age(key);
      const LaneMask better = (distance <= RECORD_DISTANCE_MAX * RECORD_DISTANCE_MAX) & (cost < best);
      best = select(best, cost, better);
      cells = select(cells, (LaneInt)(cell), better);
    }
  }
  NearestRecords nearest;
  STORE_LANES(cells, nearest.cell);
  return nearest;
}

// Finds the closest of the 3x3 samples around (x, y) that lies behind `near_depth`, the first of two alike. Returns
// whether there is one.
static inline bool find_behind(const LayerParams* params, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth,
                               float near_depth, int x, int y, Surface* found) {
  const float most = near_depth * (1.0f - LAYER_GAP_MIN);
  int best = 3;
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      const int distance = row * row + column * column;
      if (distance >= best || !(depth_at(params, depth, x + column, y + row) < most)) continue;
      const Surface other = surface_at(params, velocity, depth, x + column, y + row);
      if (!other.is_known) continue;
      best = distance;
      *found = other;
    }
  }
  return best < 3;
}

// Returns the motion of the far layer at a sample, as Reprojection has it: its own, or that of the surface behind it.
static inline float2 far_motion_at(const LayerParams* params, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth,
                                   LayerSplit split, Surface behind, int x, int y) {
  const Surface own = surface_at(params, velocity, depth, x, y);
  const bool is_far = own.is_known && own.depth < between_of(split);
  const float2 motion = (is_far ? own.motion : behind.motion) * (float2)(params->to_previous_x, params->to_previous_y);
  return clamp(motion, -FINITE_HALF_MAX, FINITE_HALF_MAX);
}

static inline void mark_tile(const LayerParams* params, __global int* marks, int x, int y) {
  const float2 place = place_of(params, x, y);
  const int tile_x = clamp((int)place.x / kTemporalTile, 0, params->tiles_x - 1);
  const int tile_y = clamp((int)place.y / kTemporalTile, 0, params->tiles_y - 1);
  atomic_or(marks + tile_y * params->tiles_x + tile_x, 1);
}

// Whether the previous frame has a record around the place that `record` comes from.
static inline bool was_known(const LayerParams* params, __global const uint* previous_keys, LayerRecord record) {
  const float2 place = (float2)(record.x + record.motion_x, record.y + record.motion_y);
  const CellRange around = previous_cells_around(params, place, KNOWN_RECORD_CELLS);
  for (int row = around.first.y; row <= around.last.y; ++row) {
    for (int column = around.first.x; column <= around.last.x; ++column) {
      if (previous_keys[row * params->previous_width + column] != 0) return true;
    }
  }
  return false;
}

__kernel void layer_split(const LayerParams params, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth,
                          __global float* open_trust, __global const uint* previous_keys, __global const uint* keys,
                          __global const LayerRecord* previous_records, __global LayerRecord* records,
                          __global float* reprojection, __global LayerSplit* splits, __global int* marks) {
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(params.columns_per_item, params.width, kWindow);
  if (item.first >= item.end || y >= params.height) return;

  for (int start = item.first; start < item.end; start += item.step) {
    const int stop = start + min((int)kWindow, pixels_from(item, start));
    if (!has_record_near(&params, keys, start, y)) continue;
    const NearestRecords nearest = find_records(&params, keys, previous_records, start, y);
    for (int x = start; x < stop; ++x) {
      const int i = y * params.width + x;
      const int cell = nearest.cell[x - start];
      if (cell >= 0) {
        const LayerRecord record = record_of(keys[cell], cell, previous_records, records);
        const float2 motion = (float2)(record.motion_x, record.motion_y);
        Surface behind;
        if (find_behind(&params, velocity, depth, record.depth, x, y, &behind) && move_apart(motion, behind.motion)) {
          const LayerSplit split = {record.depth, behind.depth, motion.x, motion.y};
          splits[i] = split;
          const float trust = fabs(open_trust[i]);
          const float2 far_motion = far_motion_at(&params, velocity, depth, split, behind, x, y);
          vstore4((float4)(far_motion, trust, as_float(SPLIT_MOTION_EDGE_BITS)),
                  texel_index(params.reprojection, x, y), reprojection);
          mark_tile(&params, marks, x, y);
          if (record_age(keys[cell]) == 0 && !was_known(&params, previous_keys, record))
            open_trust[i] = min(trust, MIXED_TRUST_MAX);
        }
      }
      if (keys[i] != 0 && record_age(keys[i]) != 0) records[i] = record_of(keys[i], i, previous_records, records);
    }
  }
}
