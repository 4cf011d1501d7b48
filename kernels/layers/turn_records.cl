// SPDX-License-Identifier: MIT
// turn_records: finds things that have stopped, started or turned about, and corrects their previous records.
//   Each record that is carried over is compared with the new record nearest to its new place, among those in the 7x7
//   cells around that have its depth. If that one moves differently, a record of age 0 takes its motion. The place of
//   an older one is then unknown: it no longer counts as thin, and so ends.
//
//   params            in      viewports, scales
//   previous_keys     in      of the previous frame's grid of records
//   keys              in      of this frame's grid: new records alone
//   records           in      LayerRecord of each of its cells that has one
//   previous_records  in/out  LayerRecord of each cell of the previous grid that has one
// Options: none
// Reference: tests/reference/layer_records.cpp
#include "layers/records.h"

// Finds the new record of the depth of `record` that is nearest to it, the first of two alike. Returns its cell; -1 if
// there is none.
static inline int find_new(const LayerParams* params, __global const uint* keys, __global const LayerRecord* records,
                           LayerRecord record) {
  const float2 at = among_samples(params, (float2)(record.x, record.y));
  const CellRange around = cells_around(at, TURNED_RECORD_CELLS, (int2)(params->width, params->height));
  float best = FLT_MAX;
  int found = -1;
  for (int row = around.first.y; row <= around.last.y; ++row) {
    for (int column = around.first.x; column <= around.last.x; ++column) {
      const int cell = row * params->width + column;
      if (keys[cell] == 0) continue;
      const float2 apart = (float2)((float)column, (float)row) - at;
      const float distance = dot(apart, apart);
      if (!(distance < best) || !have_one_depth(record.depth, records[cell].depth)) continue;
      best = distance;
      found = cell;
    }
  }
  return found;
}

static inline bool moves_otherwise(LayerRecord record, LayerRecord now) {
  const float2 motion = (float2)(now.motion_x, now.motion_y);
  const float2 change = motion - (float2)(record.motion_x, record.motion_y);
  const float steady = SUDDEN_MOTION_MIN + SUDDEN_MOTION_SHARE * length(motion);
  return dot(change, change) > steady * steady;
}

__kernel void turn_records(const LayerParams params, __global const uint* previous_keys, __global const uint* keys,
                           __global const LayerRecord* records, __global LayerRecord* previous_records) {
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(params.columns_per_item, params.previous_width, kLanes);
  if (item.first >= item.end || y >= params.previous_height) return;

  for (int start = item.first; start < item.end; start += item.step) {
    const int count = min((int)kLanes, pixels_from(item, start));
    if (!any_record(previous_keys + y * params.previous_width + start, count)) continue;
    for (int x = start; x < start + count; ++x) {
      const int i = y * params.previous_width + x;
      const uint key = previous_keys[i];
      LayerRecord record;
      if (!carry_over(key, previous_records + i, &record)) continue;
      const int cell = find_new(&params, keys, records, record);
      if (cell < 0 || !moves_otherwise(record, records[cell])) continue;
      if (record_age(key) != 0) {
        previous_records[i].is_thin = 0;
        continue;
      }
      previous_records[i].motion_x = records[cell].motion_x;
      previous_records[i].motion_y = records[cell].motion_y;
      previous_records[i].drift_x = previous_records[i].drift_y = 0.0f;
    }
  }
}
