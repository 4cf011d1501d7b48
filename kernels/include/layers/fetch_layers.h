// SPDX-License-Identifier: MIT
// Fetches a layer for pixels of a row, if texels of history may have two: finds its place in the previous frame, and
// its value there.
#pragma once

#include "bits.h"
#include "layers/layer_taps.h"
#include "temporal/constants.h"
#include "temporal/fetch_history.h"

// ---- Places in the previous frame.

// Output positions, or what is added to them.
typedef struct LayerPlaces {
  LaneFloat x, y;
} LayerPlaces;

// Places among texels: the first of the 4x4 around each, and the fraction of the way between the middle two.
typedef struct LayerSources {
  LaneInt x, y;
  LaneFloat fraction_x, fraction_y;
  LaneMask is_outside;  // lanes from beyond the previous picture's edges
  LaneMask was_split;   // lanes whose texel at their place has two layers
} LayerSources;

// Returns the tiles that hold texels (x, y), all inside.
static inline LaneInt tiles_at(const PastLayers* past, LaneInt x, LaneInt y) {
  const LaneUint tile_x = as_lane_uint(x) / (uint)kTemporalTile, tile_y = as_lane_uint(y) / (uint)kTemporalTile;
  return as_lane_int(tile_y) * past->tiles_x + as_lane_int(tile_x);
}

// Loads the phases of a layer of tiles. Most often it is one tile.
static inline LayerPlaces phases_of(const PastLayers* past, LaneInt tile, LayerKind kind) {
  if (!any_lane(tile != FIRST_LANE(tile))) {
    const float2 phase = phase_of(past, FIRST_LANE(tile), kind);
    const LayerPlaces one = {(LaneFloat)(phase.x), (LaneFloat)(phase.y)};
    return one;
  }
  __global const float* phases = kind == kNearLayer ? &past->layer_tiles->phase_x : &past->tiles->phase_x;
  const LaneInt at = tile * (int)((kind == kNearLayer ? sizeof(LayerTile) : sizeof(TileReprojection)) / sizeof(float));
  const LayerPlaces found = {gather(phases, at), gather(phases + 1, at)};
  return found;
}

// Returns the lanes whose texel has two layers.
static inline LaneMask have_two(HistoryLayer layer, LaneInt at) {
#if LANES == 8
  const LaneInt signs = (LaneInt)(confidence_sign(layer, at.s0), confidence_sign(layer, at.s1),
                                  confidence_sign(layer, at.s2), confidence_sign(layer, at.s3),
                                  confidence_sign(layer, at.s4), confidence_sign(layer, at.s5),
                                  confidence_sign(layer, at.s6), confidence_sign(layer, at.s7));
#else
  const int signs = confidence_sign(layer, at);
#endif
  return signs < 0;
}

// Returns those of `lanes` whose surface was the near layer of texel (x, y).
static inline LaneMask were_near(const PastLayers* past, DEPTH_TEXELS depth, LaneFloat surface, LaneInt x, LaneInt y,
                                 LaneMask lanes) {
  LaneFloat between = (LaneFloat)(0.0f);
  for (int i = 0; i < kLanes; ++i) {
    if (FIRST_LANE(lanes)) {
      const LayerState state = state_at(past, depth, FIRST_LANE(x), FIRST_LANE(y));
      FIRST_LANE(between) = 0.5f * (state.far_depth + state.near_depth);
    }
    between = NEXT_LANES(between);
    lanes = NEXT_LANES(lanes);
    x = NEXT_LANES(x);
    y = NEXT_LANES(y);
  }
  return lanes & (surface > between);
}

// Returns the lanes whose layer was of the other kind in texel (x, y): near layers where it has one layer, and surfaces
// alone that were its near one.
static inline LaneMask were_other(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes, LaneInt x,
                                  LaneInt y, LaneMask was_split) {
  if (wishes->kind == kNearLayer) return wishes->is_split & mask_not(was_split);
  const LaneMask may_have_been = was_split & mask_not(wishes->is_split);
  if (!any_lane(may_have_been)) return may_have_been;
  return were_near(past, depth, wishes->near_depth, x, y, may_have_been);
}

// Returns the phases of the texels that hold the wanted layers at `place`, which depend on which of their layers these
// were. Sets `was_split`.
static inline LayerPlaces source_phases(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes,
                                        LayerPlaces place, LaneMask* was_split) {
  const float last_x = (float)past->far.width - 1.0f, last_y = (float)past->far.height - 1.0f;
  const LaneInt tile = tiles_at(past, to_lane_int(clamp(place.x, 0.0f, last_x)),
                             to_lane_int(clamp(place.y, 0.0f, last_y)));
  LayerPlaces phase = phases_of(past, tile, wishes->kind);
  const LaneInt x = to_lane_int(clamp(place.x - phase.x, 0.0f, last_x));
  const LaneInt y = to_lane_int(clamp(place.y - phase.y, 0.0f, last_y));
  *was_split = have_two(past->far, y * past->far.width + x);
  const LaneMask is_other = were_other(past, depth, wishes, x, y, *was_split);
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
  LaneFloat x = at.x - phase.x - 0.5f, y = at.y - phase.y - 0.5f;  // 0 on the first texel
  from.is_outside = (x < -0.5f) | (x > (float)past->far.width - 0.5f) |
                    (y < -0.5f) | (y > (float)past->far.height - 0.5f);
  from.was_split &= mask_not(from.is_outside);
  if (is_rigid) {
    const LaneFloat nearest_x = to_lane_float(floor_lanes(x + 0.5f));
    const LaneFloat nearest_y = to_lane_float(floor_lanes(y + 0.5f));
    const LaneMask copied = (fabs(x - nearest_x) < COPIED_OFFSET_MAX) & (fabs(y - nearest_y) < COPIED_OFFSET_MAX);
    x = select(x, nearest_x, copied);
    y = select(y, nearest_y, copied);
  }
  const LaneInt base_x = floor_lanes(x), base_y = floor_lanes(y);
  from.x = base_x - 1;
  from.y = base_y - 1;
  from.fraction_x = x - to_lane_float(base_x);
  from.fraction_y = y - to_lane_float(base_y);
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

// ---- Fetching them.

// A layer of pixels as far as it is known.
typedef struct KnownLayers {
  LaneTexels texels;      // colours, times coverages, and coverages
  LaneFloat confidence;   // 0: nothing is known
  LaneFloat alpha;        // with ALPHA, times coverages
} KnownLayers;

// The same by channel.
typedef struct BlendedLayers {
  LayerColours colours;
  LaneFloat confidence;
} BlendedLayers;

static inline BlendedLayers nothing_blended(void) {
  const BlendedLayers nothing = {all_colours(0.0f), (LaneFloat)(0.0f)};
  return nothing;
}

// Takes `found` in `lanes`.
static inline void replace_lanes(BlendedLayers* known, BlendedLayers found, LaneMask lanes) {
  known->colours = select_colours(known->colours, found.colours, lanes);
  known->confidence = select(known->confidence, found.confidence, lanes);
}

// Pixels that come from as far: lane i reads the 4x4 texels from (x + i, y) on.
typedef struct LayerRun {
  int x, y;
  LaneMask lanes;
} LayerRun;

// Returns a run of the pixels in `lanes`, of which there is one.
static inline LayerRun find_run(const LayerSources* from, LaneMask lanes) {
  const LaneInt none = (LaneInt)(INT_MIN);
  const LaneInt first_x = from->x - LANE_NUMBERS;  // where the run of each lane begins
  LayerRun run;
  run.x = largest_lane(select(none, first_x, lanes));
  const LaneMask same_x = lanes & (first_x == run.x);
  run.y = largest_lane(select(none, from->y, same_x));
  run.lanes = same_x & (from->y == run.y);
  return run;
}

// Takes the layers of one texel of each pixel as they are.
static inline BlendedLayers take_taps(const LayerTaps* taps) {
  const BlendedLayers found = {taps->colours, taps->confidence};
  BlendedLayers taken = nothing_blended();
  replace_lanes(&taken, found, taps->valid);
  return taken;
}

// Copies the layers of a run whose places lie on texels.
static inline BlendedLayers copy_layers(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes,
                                        const LayerSources* from, LayerRun run) {
  const RowWindows windows = windows_from(past, run.x + 1, run.y + 1, 1, false);
  const LayerRow row = load_layer_row(past, depth, windows, 0, 0);
  const LayerTaps taps = taps_of(&row, 0, wishes, from->was_split);
  return take_taps(&taps);
}

// Returns the weights with the second tap's as the first, and the first one's as the last.
static inline Cubic next_taps(Cubic w) {
  const Cubic next = {w.w1, w.w2, w.w3, w.w0};
  return next;
}

// Resamples the layers of a run, or copies them.
static inline BlendedLayers sample_layers(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes,
                                          const LayerSources* from, LayerRun run) {
  const LaneFloat zero = (LaneFloat)(0.0f);
  const bool copied = !any_lane(run.lanes & ((from->fraction_x > zero) | (from->fraction_y > zero)));
  if (copied) return copy_layers(past, depth, wishes, from, run);
  const RowWindows windows = windows_from(past, run.x, run.y, 4, true);
  Cubic wx = cubic_weights(from->fraction_x, HISTORY_SHARPNESS);  // after four turns the first is the first again
  Cubic wy = cubic_weights(from->fraction_y, HISTORY_SHARPNESS);
  LayerSums sums = no_taps();
  UNROLL(4)
  for (int y = 0; y < 4; ++y) {
    LayerRow row;
    const LaneFloat linear_y = middle_weight(y, from->fraction_y);
    UNROLL(4)
    for (int x = 0; x < 4; ++x) {
      if (LANES == 1 || x == 0) row = load_layer_row(past, depth, windows, y, x);
      const LayerTaps taps = taps_of(&row, x, wishes, from->was_split);
      add_taps(&sums, &taps, wx.w0 * wy.w0);
      if (is_middle_tap(x) && is_middle_tap(y))
        add_middle_taps(&sums, &taps, middle_weight(x, from->fraction_x) * linear_y);
      wx = next_taps(wx);
    }
    wy = next_taps(wy);
  }
  const LaneMask is_alone = wishes->kind == kFarLayer ? mask_not(wishes->is_split) : mask_of(false);
  const BlendedLayers blended = {blend_colours(&sums), blend_confidence(&sums, is_alone)};
  return blended;
}

// Whether the places are texels of a row, side by side, all inside.
static inline bool lie_side_by_side(const PastLayers* past, const LayerSources* from) {
  const LaneMask other = (from->x - LANE_NUMBERS != FIRST_LANE(from->x)) | (from->y != FIRST_LANE(from->y));
  if (any_lane(other | from->is_outside | (from->fraction_x > 0.0f) | (from->fraction_y > 0.0f))) return false;
  return FIRST_LANE(from->x) >= -1 && FIRST_LANE(from->x) + 1 + kTemporalTile <= past->far.width;
}

// Whether none of those has two layers.
static inline bool have_one(const PastLayers* past, const LayerSources* from) {
  const int first = (FIRST_LANE(from->y) + 1) * past->far.width + FIRST_LANE(from->x) + 1;
  return !any_lane(as_lane_int(confidences(load_history_lanes(past->far, first))) < 0);
}

// Fetches surfaces alone among texels of one layer, as resolve_temporal does.
static inline KnownLayers fetch_alone(const PastLayers* past, const LayerSources* from, bool copied) {
  const SourcePlaces places = {{from->x, from->fraction_x}, {from->y, from->fraction_y}};
  const FetchedHistory history = copied ? copy_history(past->far, FIRST_LANE(from->x) + 1, FIRST_LANE(from->y) + 1)
                                        : resample_history(past->far, places);
  const LaneFloat coverage = select((LaneFloat)(1.0f), (LaneFloat)(0.0f), from->is_outside);
  KnownLayers known = {with_last(history.texels, coverage), history.confidence, (LaneFloat)(1.0f)};
#if ALPHA
  known.alpha = resample_alpha(past->alpha, places);
#endif
  return known;
}

// Samples the layers of the pixels in `left`, run by run; of the others nothing.
static inline KnownLayers sample_lanes(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes,
                                       const LayerSources* from, LaneMask left) {
  BlendedLayers found = nothing_blended();
  while (any_lane(left)) {
    const LayerRun run = find_run(from, left);
    replace_lanes(&found, sample_layers(past, depth, wishes, from, run), run.lanes);
    left &= mask_not(run.lanes);
    if (kLanes == 1) break;  // one lane means one run; compilers cannot prove it
  }
  const LayerColours c = found.colours;
  const KnownLayers known = {texels_of(c.red, c.green, c.blue, c.coverage), found.confidence, c.alpha};
  return known;
}

// Fetches the wanted layers of the pixels in `lanes`; of the others nothing.
static inline KnownLayers fetch_layers(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes,
                                       const LayerSources* from, LaneMask lanes) {
  if (wishes->kind == kFarLayer && !any_lane(wishes->is_split)) {
    const bool copied = lie_side_by_side(past, from);
    if ((copied && have_one(past, from)) || !may_meet_two(past, from)) return fetch_alone(past, from, copied);
  }
  return sample_lanes(past, depth, wishes, from, lanes & mask_not(from->is_outside));
}
