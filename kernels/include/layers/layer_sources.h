// SPDX-License-Identifier: MIT
// Where the layers of eight pixels of a row were in the previous frame.
#pragma once

#include "layers/layer_taps.h"

#define LAYER_COPIED 0.06f  // texels: a place of a rigid layer this near to a texel is that texel
#define FARTHEST_TILES 4    // between places: farther apart they are not looked at together

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

// Of the far layers of tiles, or of their near ones. Most often it is one tile.
static inline LayerPlaces phases_of(const PastLayers* past, int8 tile, LayerKind kind) {
  const bool near = kind == kNearLayer;
  __global const float* phases = near ? &past->layer_tiles->phase_x : &past->tiles->phase_x;
  const int8 at = tile * (int)((near ? sizeof(LayerTile) : sizeof(TileReprojection)) / sizeof(float));
  if (!any_lane(tile ^ tile.s0)) {
    const LayerPlaces phase = {(float8)(phases[at.s0]), (float8)(phases[at.s0 + 1])};
    return phase;
  }
  const LayerPlaces phase = {(float8)(phases[at.s0], phases[at.s1], phases[at.s2], phases[at.s3], phases[at.s4],
                                      phases[at.s5], phases[at.s6], phases[at.s7]),
                             (float8)(phases[at.s0 + 1], phases[at.s1 + 1], phases[at.s2 + 1], phases[at.s3 + 1],
                                      phases[at.s4 + 1], phases[at.s5 + 1], phases[at.s6 + 1], phases[at.s7 + 1])};
  return phase;
}

// Lanes whose texel has two layers.
static inline int8 have_two(HistoryLayer layer, int8 at) {
  const int8 signs = (int8)(confidence_sign(layer, at.s0), confidence_sign(layer, at.s1),
                            confidence_sign(layer, at.s2), confidence_sign(layer, at.s3),
                            confidence_sign(layer, at.s4), confidence_sign(layer, at.s5),
                            confidence_sign(layer, at.s6), confidence_sign(layer, at.s7));
  return signs >> 31;
}

// Those of `lanes` whose surface was the near layer of texel (x, y).
static inline int8 were_near(const PastLayers* past, DEPTH_TEXELS depth, TexelLayout layout, float8 surface, int8 x,
                             int8 y, int8 lanes) {
  float near_depth[8];
  int column[8], row[8], is_near[8];
  vstore8(surface, 0, near_depth);
  vstore8(x, 0, column);
  vstore8(y, 0, row);
  vstore8(lanes, 0, is_near);
  for (int i = 0; i < 8; ++i) {
    if (is_near[i] == 0) continue;
    is_near[i] = near_depth[i] > between_layers(state_at(past, depth, layout, column[i], row[i])) ? -1 : 0;
  }
  return vload8(0, is_near);
}

// Of the wanted layers at `place`; `is_rigid`: they are. The phase that a texel has depends on which of its layers it
// is.
static inline LayerSources find_sources(const PastLayers* past, DEPTH_TEXELS depth, TexelLayout layout,
                                        const LayerWishes* wishes, LayerPlaces place, bool is_rigid) {
  const float last_x = (float)past->far.width - 1.0f, last_y = (float)past->far.height - 1.0f;
  const float8 at_x = clamp(place.x, -FARTHEST_SOURCE, FARTHEST_SOURCE);
  const float8 at_y = clamp(place.y, -FARTHEST_SOURCE, FARTHEST_SOURCE);
  const int8 column = convert_int8(clamp(at_x, 0.0f, last_x)), row = convert_int8(clamp(at_y, 0.0f, last_y));
  const uint8 tile_x = as_uint8(column) / (uint)kTemporalTile, tile_y = as_uint8(row) / (uint)kTemporalTile;
  const int8 tile = as_int8(tile_y) * past->tiles_x + as_int8(tile_x);
  LayerPlaces phase = phases_of(past, tile, wishes->kind);
  const int8 there_x = convert_int8(clamp(at_x - phase.x, 0.0f, last_x));
  const int8 there_y = convert_int8(clamp(at_y - phase.y, 0.0f, last_y));

  LayerSources from;
  from.was_split = have_two(past->far, there_y * past->far.width + there_x);
  const bool near = wishes->kind == kNearLayer;
  int8 is_other = near ? wishes->is_split & ~from.was_split : from.was_split & ~wishes->is_split;
  if (any_lane(is_other)) {
    if (!near) is_other = were_near(past, depth, layout, wishes->near_depth, there_x, there_y, is_other);
    const LayerPlaces other = phases_of(past, tile, near ? kFarLayer : kNearLayer);
    phase.x = select(phase.x, other.x, is_other);
    phase.y = select(phase.y, other.y, is_other);
  }

  float8 x = at_x - phase.x - 0.5f, y = at_y - phase.y - 0.5f;  // 0 on the first texel
  from.is_outside = (x < -0.5f) | (x > last_x + 0.5f) | (y < -0.5f) | (y > last_y + 0.5f);
  from.was_split &= ~from.is_outside;
  if (is_rigid) {
    const float8 nearest_x = floor(x + 0.5f), nearest_y = floor(y + 0.5f);
    const int8 copied = (fabs(x - nearest_x) < LAYER_COPIED) & (fabs(y - nearest_y) < LAYER_COPIED);
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
  if (right - left > FARTHEST_TILES || bottom - top > FARTHEST_TILES) return true;
  int any = 0;
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) any |= past->layer_tiles[y * past->tiles_x + x].is_split;
  }
  return any != 0;
}
