// SPDX-License-Identifier: MIT
// advect_records: carries the records of thin things over from the previous frame, each to the cell at the end of its
// motion. A record of this frame, or a younger one, keeps its cell.
//
//   params            in      viewports, scales
//   previous_keys     in      of the previous frame's grid of records
//   previous_records  in      LayerRecord of each of its cells that has one
//   keys              in/out  of this frame's grid
// Options: none
// Reference: tests/reference/layer_records.cpp
#include "layers/records.h"

// Finds the cell of this frame's grid that holds a place in output pixels. Returns whether there is one.
static inline bool find_cell(const LayerParams* params, float2 place, int* cell) {
  const float2 at = among_samples(params, place) + 0.5f;
  if (!(at.x >= 0.0f && at.y >= 0.0f && at.x < (float)params->width && at.y < (float)params->height)) return false;
  *cell = (int)at.y * params->width + (int)at.x;
  return true;
}

__kernel void advect_records(const LayerParams params, __global const uint* previous_keys,
                             __global const LayerRecord* previous_records, __global uint* keys) {
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
      int cell;
      if (!carry_over(key, previous_records + i, &record)) continue;
      if (find_cell(&params, (float2)(record.x, record.y), &cell))
        atomic_max(keys + cell, record_key(record_age(key) + 1, i));
    }
  }
}
