// SPDX-License-Identifier: MIT
// advect_records: carries the records of thin things over from the previous frame, each to the cell that its motion
// leads to. A record of this frame, or a younger one, keeps its cell.
//
//   params            in      viewports, scales
//   previous_keys     in      of the previous frame's grid of records
//   previous_records  in      LayerRecord of each of its cells that has one
//   keys              in/out  of this frame's grid
// Options: none
// Reference: tests/reference/layer_records.cpp
#include "layers/records.h"

__kernel void advect_records(const LayerParams params, __global const uint* previous_keys,
                             __global const LayerRecord* previous_records, __global uint* keys) {
  const int y = get_global_id(1);
  const int first = get_global_id(0) * params.columns_per_item;
  if (first >= params.previous_width || y >= params.previous_height) return;

  const int end = min(first + params.columns_per_item, params.previous_width);
  for (int x = first; x < end; ++x) {
    const int i = y * params.previous_width + x;
    const uint key = previous_keys[i];
    if (!is_carried_over(key, previous_records + i)) continue;
    const LayerRecord record = advanced(previous_records[i]);
    int2 cell;
    if (!cell_at(&params, record.x, record.y, &cell)) continue;
    atomic_max(keys + cell.y * params.width + cell.x, record_key(record_age(key) + 1, i));
  }
}
