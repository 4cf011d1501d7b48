// SPDX-License-Identifier: MIT
// resize_records: converts the previous frame's records to pixels of an output of another size.
//
//   width, height  in      of the grid: the previous frame's viewport
//   ratio          in      pixels of this output in each of the previous one
//   keys           in      of the grid
//   records        in/out  LayerRecord of each of its cells that has one
// Options: none
// Reference: tests/kernels/resize_history_test.cpp
#include "layers/records.h"

__kernel void resize_records(const int width, const int height, const int columns_per_item, const float2 ratio,
                             __global const uint* keys, __global LayerRecord* records) {
  const int y = get_global_id(1);
  const int first = get_global_id(0) * columns_per_item;
  if (first >= width || y >= height) return;

  const int end = min(first + columns_per_item, width);
  for (int x = first; x < end; ++x) {
    const int i = y * width + x;
    if (keys[i] == 0) continue;
    LayerRecord record = records[i];
    record.x *= ratio.x;
    record.y *= ratio.y;
    record.motion_x *= ratio.x;
    record.motion_y *= ratio.y;
    record.drift_x *= ratio.x;
    record.drift_y *= ratio.y;
    records[i] = record;
  }
}
