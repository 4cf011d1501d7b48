// SPDX-License-Identifier: MIT
// The grid of records: one cell for each sample of a viewport, row by row. A cell's *key* tells whose record it holds:
// 0 nobody's; else the younger the record the larger the key, and among those of one age that of the first cell.
// Atomic maxima of keys so give the same grid in whatever order records arrive.
#pragma once

#include "layers/surfaces.h"

#define OLDEST_RECORD 8  // frames for which a record outlives its sample

static inline uint record_key(int age, int index) {
  return (uint)(15 - age) << 28 | (0x0fffffffu - (uint)index);
}

static inline int record_age(uint key) {
  return 15 - (int)(key >> 28);
}

// The cell, in the grid of the frame that it was found in or comes from.
static inline int record_index(uint key) {
  return (int)(0x0fffffffu - (key & 0x0fffffffu));
}

// Whether a record of the previous grid is carried over: those of thin things are, until they are too old.
static inline bool is_carried_over(uint key, __global const LayerRecord* record) {
  return key != 0 && record_age(key) < OLDEST_RECORD && record->is_thin;
}

// A record of the previous frame in this one.
static inline LayerRecord advanced(LayerRecord record) {
  record.motion_x += record.drift_x;
  record.motion_y += record.drift_y;
  record.x -= record.motion_x;
  record.y -= record.motion_y;
  return record;
}

// The cell of this frame's grid that holds a place; false if none does.
static inline bool cell_at(const LayerParams* params, float x, float y, int2* cell) {
  const float column = floor((x - params->start_x) / params->spacing_x + 0.5f);
  const float row = floor((y - params->start_y) / params->spacing_y + 0.5f);
  if (!(column >= 0.0f && row >= 0.0f && column < (float)params->width && row < (float)params->height)) return false;
  *cell = (int2)((int)column, (int)row);
  return true;
}
