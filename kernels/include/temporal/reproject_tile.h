// SPDX-License-Identifier: MIT
// The samples of a tile, and the reprojection of the whole tile if they move alike.
#pragma once

#include "arithmetic.h"
#include "motion/motion_edge.h"
#include "temporal/constants.h"
#include "temporal/temporal_params.h"
#include "texel.h"

enum { kReprojectionAhead = 8 };  // samples to prefetch

// Returns the tile that holds output position (x, y), clamped to the edge.
static inline int tile_at(const TemporalTileParams* params, float x, float y) {
  const int tile_x = clamp((int)x / kTemporalTile, 0, params->tiles_x - 1);
  const int tile_y = clamp((int)y / kTemporalTile, 0, params->tiles_y - 1);
  return tile_y * params->tiles_x + tile_x;
}

// Where the middle of a tile was that moves by `motion`, as a tile of the previous frame.
static inline int source_tile(const TemporalTileParams* params, float2 corner, float2 motion) {
  const float2 source = corner + 0.5f * (float)kTemporalTile + motion;
  return tile_at(params, source.x, source.y);
}

// A motion of which velocity's rounding is all is none.
static inline float2 without_rounding(float2 motion) {
  return select(motion, (float2)(0.0f), fabs(motion) < (float2)(STILL_MOTION_MAX));
}

// How texels follow their motion: by a step of whole texels, and by a phase that takes up the rest.
typedef struct PhaseStep {
  int2 step;
  float2 phase;
} PhaseStep;

// Follows `motion` from texels of the phase `source`.
static inline PhaseStep carry_phase(float2 source, float2 motion) {
  const float2 place = source - motion;
  const int2 step = floor2(place + 0.5f);
  const PhaseStep carried = {step, place - convert_float2(step)};
  return carried;
}

static inline void take_phase(TileReprojection* tile, float2 source, float2 motion) {
  const PhaseStep carried = carry_phase(source, motion);
  tile->source_phase_x = source.x;
  tile->source_phase_y = source.y;
  tile->phase_x = carried.phase.x;
  tile->phase_y = carried.phase.y;
  tile->step_x = carried.step.x;
  tile->step_y = carried.step.y;
}

// The samples from `first` to `last`, each a column and a row.
typedef struct SampleRange {
  int2 first, last;
} SampleRange;

// Returns the samples whose centres lie in a tile; at least one.
static inline SampleRange samples_in_tile(const TemporalTileParams* params, float2 corner) {
  const int2 limit = (int2)(params->frame.width - 1, params->frame.height - 1);
  const float2 spacing = (float2)(params->spacing_x, params->spacing_y);
  const float2 start = (float2)(params->start_x, params->start_y);
  // The first at or beyond an edge.
  const int2 first = clamp(-floor2((start - corner) / spacing), (int2)(0), limit);
  const int2 last = clamp(-floor2((start - (corner + (float)kTemporalTile)) / spacing) - 1, first, limit);
  const SampleRange range = {first, last};
  return range;
}

#if MOTION
// Returns them and the next samples around them.
static inline SampleRange widened(const TemporalTileParams* params, SampleRange range) {
  const int2 limit = (int2)(params->frame.width - 1, params->frame.height - 1);
  const SampleRange around = {max(range.first - 1, (int2)(0)), min(range.last + 1, limit)};
  return around;
}

static inline float16 four_times(float4 value) {
  return (float16)(value, value, value, value);
}

// The range of each field of Reprojection, and whether no trust is NaN.
typedef struct ReprojectionRange {
  float4 least, most;
  bool is_known;
} ReprojectionRange;

static inline ReprojectionRange range_of(__global const float* reprojection, TexelLayout layout, SampleRange samples) {
  const int2 first = samples.first, last = samples.last;
  float16 least = (float16)(65536.0f), most = (float16)(-65536.0f);  // beyond all that Reprojection holds
  float16 sum = (float16)(0.0f);
  const bool wide = last.x >= first.x + 3;
  for (int y = first.y; y <= last.y; ++y) {
    __global const float* row = reprojection + 4 * row_index(layout, y);
    WILL_READ(row + 4 * (last.x + kReprojectionAhead));
    WILL_READ(row + 4 * (last.x + kReprojectionAhead + 4));
    for (int x = first.x; x <= last.x; x += wide ? 4 : 1) {
      const float16 four = wide ? vload16(0, row + 4 * min(x, last.x - 3)) : four_times(vload4(x, row));
      least = min(least, four);
      most = max(most, four);
      sum += four;
    }
  }
  const float8 least8 = min(least.lo, least.hi), most8 = max(most.lo, most.hi);
  const float trusts = (sum.s2 + sum.s6) + (sum.sa + sum.se);
  const ReprojectionRange range = {min(least8.lo, least8.hi), max(most8.lo, most8.hi), trusts == trusts};
  return range;
}

// Returns how a tile takes history over whose samples, and the next ones around it, have these reprojections.
static inline TileReprojection reproject_tile(const TemporalTileParams* params, ReprojectionRange found,
                                              __global const TileReprojection* previous, float2 corner) {
  TileReprojection tile = {.is_rigid = 0};
  const float edge = max(found.most.w, -found.least.w);
  tile.has_motion_edge = edge > REJECTED_EDGE_MIN ? 1 : 0;
  const float2 least = found.least.xy, most = found.most.xy;
  const float2 scale = (float2)(params->motion_x, params->motion_y);
  const float2 range = (most - least) * scale;
  const bool known = found.is_known && found.least.z >= 0.0f;
  if (!known || !(range.x <= RIGID_MOTION_RANGE_MAX && range.y <= RIGID_MOTION_RANGE_MAX)) return tile;

  const float2 motion = without_rounding(0.5f * (most + least) * scale);
  // A tile that comes in from beyond the edges takes the outermost tile's phase: a long pan stays of one piece.
  const int from = source_tile(params, corner, motion);
  take_phase(&tile, (float2)(previous[from].phase_x, previous[from].phase_y), motion);
  tile.is_rigid = 1;
  tile.is_trusted = found.least.z == 1.0f && edge <= COSTLY_EDGE_MIN ? 1 : 0;
  return tile;
}
#endif
