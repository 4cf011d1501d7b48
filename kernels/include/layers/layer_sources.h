// SPDX-License-Identifier: MIT
// Where the layers of eight pixels of a row were in the previous frame.
#pragma once

#include "bits.h"
#include "layers/layer_taps.h"
#include "temporal/constants.h"

// Output positions, or what is added to them.
typedef struct LayerPlaces {
  float8 x, y;
} LayerPlaces;

// Places among texels: the first of the 4x4 around each, and the fraction of the way between the middle two.
typedef struct LayerSources {
  int8 x, y;
  float8 fraction_x, fraction_y;
  int8 is_outside;  // lanes from beyond the previous picture's edges
  int8 was_split;   // lanes whose texel at their place has two layers
} LayerSources;

// Returns the tiles that hold texels (x, y), all inside.
static inline int8 tiles_at(const PastLayers* past, int8 x, int8 y) {
  const uint8 tile_x = as_uint8(x) / (uint)kTemporalTile, tile_y = as_uint8(y) / (uint)kTemporalTile;
  return as_int8(tile_y) * past->tiles_x + as_int8(tile_x);
}

// Loads the phases of a layer of eight tiles. Most often it is one tile.
static inline LayerPlaces phases_of(const PastLayers* past, int8 tile, LayerKind kind) {
  const float2 p0 = phase_of(past, tile.s0, kind);
  if (!any_lane(tile ^ tile.s0)) {
    const LayerPlaces one = {(float8)(p0.x), (float8)(p0.y)};
    return one;
  }
  const float2 p1 = phase_of(past, tile.s1, kind), p2 = phase_of(past, tile.s2, kind);
  const float2 p3 = phase_of(past, tile.s3, kind), p4 = phase_of(past, tile.s4, kind);
  const float2 p5 = phase_of(past, tile.s5, kind), p6 = phase_of(past, tile.s6, kind);
  const float2 p7 = phase_of(past, tile.s7, kind);
  const LayerPlaces phases = {(float8)(p0.x, p1.x, p2.x, p3.x, p4.x, p5.x, p6.x, p7.x),
                              (float8)(p0.y, p1.y, p2.y, p3.y, p4.y, p5.y, p6.y, p7.y)};
  return phases;
}

// Returns the lanes whose texel has two layers.
static inline int8 have_two(HistoryLayer layer, int8 at) {
  const int8 signs = (int8)(confidence_sign(layer, at.s0), confidence_sign(layer, at.s1),
                            confidence_sign(layer, at.s2), confidence_sign(layer, at.s3),
                            confidence_sign(layer, at.s4), confidence_sign(layer, at.s5),
                            confidence_sign(layer, at.s6), confidence_sign(layer, at.s7));
  return signs >> 31;
}

// Returns those of `lanes` whose surface was the near layer of texel (x, y).
static inline int8 were_near(const PastLayers* past, DEPTH_TEXELS depth, float8 surface, int8 x, int8 y, int8 lanes) {
  for (int i = 0; i < kLanes; ++i) {
    if (lanes.s0 != 0) {
      const LayerState state = state_at(past, depth, x.s0, y.s0);
      lanes.s0 = surface.s0 > 0.5f * (state.far_depth + state.near_depth) ? -1 : 0;
    }
    lanes = NEXT_LANES(lanes);
    surface = NEXT_LANES(surface);
    x = NEXT_LANES(x);
    y = NEXT_LANES(y);
  }
  return lanes;
}

// Returns the lanes whose layer was of the other kind in texel (x, y): near layers where it has one layer, and surfaces
// alone that were its near one.
static inline int8 were_other(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes, int8 x, int8 y,
                              int8 was_split) {
  if (wishes->kind == kNearLayer) return wishes->is_split & ~was_split;
  const int8 may_have_been = was_split & ~wishes->is_split;
  if (!any_lane(may_have_been)) return may_have_been;
  return were_near(past, depth, wishes->near_depth, x, y, may_have_been);
}

// Returns the phases of the texels that hold the wanted layers at `place`, which depend on which of their layers these
// were. Sets `was_split`.
static inline LayerPlaces source_phases(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes,
                                        LayerPlaces place, int8* was_split) {
  const float last_x = (float)past->far.width - 1.0f, last_y = (float)past->far.height - 1.0f;
  const int8 tile = tiles_at(past, convert_int8(clamp(place.x, 0.0f, last_x)),
                             convert_int8(clamp(place.y, 0.0f, last_y)));
  LayerPlaces phase = phases_of(past, tile, wishes->kind);
  const int8 x = convert_int8(clamp(place.x - phase.x, 0.0f, last_x));
  const int8 y = convert_int8(clamp(place.y - phase.y, 0.0f, last_y));
  *was_split = have_two(past->far, y * past->far.width + x);
  const int8 is_other = were_other(past, depth, wishes, x, y, *was_split);
  if (any_lane(is_other)) {
    const LayerPlaces other = phases_of(past, tile, wishes->kind == kNearLayer ? kFarLayer : kNearLayer);
    phase.x = select(phase.x, other.x, is_other);
    phase.y = select(phase.y, other.y, is_other);
  }
  return phase;
}

// Finds the wanted layers at `place`. A rigid layer's place that lies almost on a texel is put on it.
static inline LayerSources find_sources(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes,
                                        LayerPlaces place, bool is_rigid) {
  const LayerPlaces at = {clamp(place.x, -SOURCE_DISTANCE_MAX, SOURCE_DISTANCE_MAX),
                          clamp(place.y, -SOURCE_DISTANCE_MAX, SOURCE_DISTANCE_MAX)};
  LayerSources from;
  const LayerPlaces phase = source_phases(past, depth, wishes, at, &from.was_split);
  float8 x = at.x - phase.x - 0.5f, y = at.y - phase.y - 0.5f;  // 0 on the first texel
  from.is_outside = (x < -0.5f) | (x > (float)past->far.width - 0.5f) |
                    (y < -0.5f) | (y > (float)past->far.height - 0.5f);
  from.was_split &= ~from.is_outside;
  if (is_rigid) {
    const float8 nearest_x = floor(x + 0.5f), nearest_y = floor(y + 0.5f);
    const int8 copied = (fabs(x - nearest_x) < COPIED_OFFSET_MAX) & (fabs(y - nearest_y) < COPIED_OFFSET_MAX);
    x = select(x, nearest_x, copied);
    y = select(y, nearest_y, copied);
  }
  const float8 base_x = floor(x), base_y = floor(y);
  from.x = convert_int8(base_x) - 1;
  from.y = convert_int8(base_y) - 1;
  from.fraction_x = x - base_x;
  from.fraction_y = y - base_y;
  return from;
}

// Whether a texel around one of the places may have two layers.
static inline bool may_meet_two(const PastLayers* past, const LayerSources* from) {
  const int left = clamp(smallest_lane(from->x) / kTemporalTile, 0, past->tiles_x - 1);
  const int top = clamp(smallest_lane(from->y) / kTemporalTile, 0, past->tiles_y - 1);
  const int right = clamp((largest_lane(from->x) + 3) / kTemporalTile, 0, past->tiles_x - 1);
  const int bottom = clamp((largest_lane(from->y) + 3) / kTemporalTile, 0, past->tiles_y - 1);
  if (right - left > SCANNED_TILES_MAX || bottom - top > SCANNED_TILES_MAX) return true;
  int any = 0;
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) any |= past->layer_tiles[y * past->tiles_x + x].is_split;
  }
  return any != 0;
}
