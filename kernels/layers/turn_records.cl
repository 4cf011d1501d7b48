// SPDX-License-Identifier: MIT
// turn_records: things stop, start and turn about, and their records of the previous frame with them.
//   Each that is carried over is compared with the new record nearest to where it comes, of those in the 7x7 cells
//   around that have its depth. If that one moves otherwise, a record that a sample showed in the previous frame takes
//   its motion. The place of an older one is not known any more: it no longer counts as thin, and so ends.
//
//   params            in      viewports, scales
//   previous_keys     in      of the previous frame's grid of records
//   keys              in      of this frame's grid: new records alone
//   records           in      LayerRecord of each of its cells that has one
//   previous_records  in/out  LayerRecord of each cell of the previous grid that has one
// Options: none
// Reference: tests/reference/turn_records.cpp
#include "layers/records.h"

#define STEADY 0.25f  // pixels a frame, and part of the new motion: less is no sudden change

enum { kTurnReach = 3 };  // cells around a record

// The cell of the new record of the depth of `record` that is nearest to it, the first of two alike; -1 if there is
// none.
static inline int find_new(const LayerParams* params, __global const uint* keys, __global const LayerRecord* records,
                           LayerRecord record) {
  const float2 at = clamp((float2)((record.x - params->start_x) / params->spacing_x,
                                   (record.y - params->start_y) / params->spacing_y), -8.0f, 65536.0f);
  const int2 middle = convert_int2(floor(at + 0.5f));
  float best = FLT_MAX;
  int found = -1;
  for (int row = max(middle.y - kTurnReach, 0); row <= min(middle.y + kTurnReach, params->height - 1); ++row) {
    for (int column = max(middle.x - kTurnReach, 0); column <= min(middle.x + kTurnReach, params->width - 1);
         ++column) {
      const int cell = row * params->width + column;
      if (keys[cell] == 0) continue;
      const float2 apart = (float2)((float)column, (float)row) - at;
      const float distance = dot(apart, apart);
      if (!(distance < best) || fabs(records[cell].depth - record.depth) > LAYER_GAP * record.depth) continue;
      best = distance;
      found = cell;
    }
  }
  return found;
}

static inline bool moves_otherwise(LayerRecord record, LayerRecord now) {
  const float2 motion = (float2)(now.motion_x, now.motion_y);
  const float2 change = motion - (float2)(record.motion_x, record.motion_y);
  const float most = STEADY + STEADY * length(motion);
  return dot(change, change) > most * most;
}

__kernel void turn_records(const LayerParams params, __global const uint* previous_keys, __global const uint* keys,
                           __global const LayerRecord* records, __global LayerRecord* previous_records) {
  const int y = get_global_id(1);
  const int first = get_global_id(0) * params.columns_per_item;
  if (first >= params.previous_width || y >= params.previous_height) return;

  const int end = min(first + params.columns_per_item, params.previous_width);
  for (int x = first; x < end; ++x) {
    const int i = y * params.previous_width + x;
    const uint key = previous_keys[i];
    if (!is_carried_over(key, previous_records + i)) continue;
    const LayerRecord record = advanced(previous_records[i]);
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
