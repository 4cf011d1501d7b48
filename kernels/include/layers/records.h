// SPDX-License-Identifier: MIT
// Surfaces at single samples, and the grid of records: one cell for each sample of a viewport, row by row.
//
// A cell's *key* names its record: 0 for none; else the younger the record the larger the key, and of one age that
// from the first cell is the largest. So atomic maxima of keys give the same grid in whatever order records come.
#pragma once

#include "arithmetic.h"
#include "bits.h"
#include "layers/constants.h"
#include "layers/layer.h"
#include "texel.h"

typedef struct Surface {
  float depth;
  float2 motion;   // output pixels, within +-FINITE_HALF_MAX
  bool is_known;   // velocity and depth are finite
} Surface;

// Loads the depth of sample (x, y), clamped to the edge.
static inline float depth_at(const LayerParams* params, DEPTH_TEXELS depth, int x, int y) {
  const int column = clamp(x, 0, params->width - 1), row = clamp(y, 0, params->height - 1);
  return load_depth(depth, params->depth, column, row);
}

// Loads what sample (x, y) shows, clamped to the edge.
static inline Surface surface_at(const LayerParams* params, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth, int x,
                                 int y) {
  const int column = clamp(x, 0, params->width - 1), row = clamp(y, 0, params->height - 1);
  const float2 moves = load_velocity(velocity, params->velocity, column, row);
  const float2 motion = moves * (float2)(params->motion_x, params->motion_y);
  Surface surface;
  surface.depth = depth_at(params, depth, x, y);
  surface.motion = clamp(motion, -FINITE_HALF_MAX, FINITE_HALF_MAX);
  surface.is_known = !any_non_finite4((float4)(moves, surface.depth, 0.0f));
  return surface;
}

static inline bool move_apart(float2 a, float2 b) {
  const float2 apart = a - b;
  return dot(apart, apart) > LAYER_MOTION_MIN * LAYER_MOTION_MIN;
}

// Whether two depths are of one surface, by the gap between layers.
static inline bool have_one_depth(float depth, float other) {
  return !(fabs(other - depth) > LAYER_GAP_MIN * depth);
}

// ---- Places.

// Returns the centre of sample (x, y), output pixels.
static inline float2 place_of(const LayerParams* params, int x, int y) {
  return (float2)((float)x * params->spacing_x + params->start_x, (float)y * params->spacing_y + params->start_y);
}

// Counts a place in samples of this frame, 0 at the first.
static inline float2 among_samples(const LayerParams* params, float2 place) {
  return (place - (float2)(params->start_x, params->start_y)) / (float2)(params->spacing_x, params->spacing_y);
}

// The cells of a grid within reach of one: columns and rows from the first to the last; none if first > last.
typedef struct CellRange {
  int2 first, last;
} CellRange;

// Returns the cells of a grid of `extent` at most `reach` from the one that holds `at`, counted in samples.
static inline CellRange cells_around(float2 at, int reach, int2 extent) {
  const int2 middle = floor2(clamp(at + 0.5f, -8.0f, 65536.0f));
  const CellRange range = {max(middle - reach, (int2)(0)), min(middle + reach, extent - 1)};
  return range;
}

// The same of the previous frame's grid, around a place in output pixels.
static inline CellRange previous_cells_around(const LayerParams* params, float2 place, int reach) {
  const float2 spacing = (float2)(params->previous_spacing_x, params->previous_spacing_y);
  const float2 start = (float2)(params->previous_start_x, params->previous_start_y);
  return cells_around((place - start) / spacing, reach, (int2)(params->previous_width, params->previous_height));
}

// ---- Keys and records.

static inline uint record_key(int age, int index) {
  return (uint)(15 - age) << 28 | (0x0fffffffu - (uint)index);
}

static inline int record_age(uint key) {
  return 15 - (int)(key >> 28);
}

// Returns the record's cell in the grid of the frame that it was found in or comes from.
static inline int record_index(uint key) {
  return (int)(0x0fffffffu - (key & 0x0fffffffu));
}

// Whether one of `count` cells, at most one a lane, has a record.
static inline bool any_record(__global const uint* keys, int count) {
#if LANES == 8
  if (count == kLanes) return any_of_eight(as_int8(vload8(0, keys)));
#endif
  uint any = 0;
  for (int i = 0; i < count; ++i) any |= keys[i];
  return any != 0;
}

// Moves a record of the previous frame on to this one.
static inline LayerRecord advanced(LayerRecord record) {
  record.motion_x += record.drift_x;
  record.motion_y += record.drift_y;
  record.x -= record.motion_x;
  record.y -= record.motion_y;
  return record;
}

// Carries the record of a cell of the previous grid over to this frame. Returns whether it is: those of thin things
// are, until they are too old.
static inline bool carry_over(uint key, __global const LayerRecord* before, LayerRecord* record) {
  if (key == 0 || record_age(key) >= RECORD_AGE_MAX || !before->is_thin) return false;
  *record = advanced(*before);
  return true;
}
