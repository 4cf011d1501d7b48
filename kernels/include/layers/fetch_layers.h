// SPDX-License-Identifier: MIT
// Fetching a layer of eight pixels of a row where texels of history may have two: where it was, and what it was.
#pragma once

#include "bits.h"
#include "layers/layer_taps.h"
#include "temporal/constants.h"
#include "temporal/fetch_history.h"

// ---- Places in the previous frame.

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

// ---- Fetching them.

// A layer of eight pixels as far as it is known.
typedef struct KnownLayers {
  EightTexels texels;  // premultiplied colours and coverages
  float8 confidence;   // 0: nothing is known
  float8 alpha;        // 1 without ALPHA
} KnownLayers;

// The same by channel.
typedef struct BlendedLayers {
  LayerColours colours;
  Lanes confidence;
} BlendedLayers;

static inline BlendedLayers nothing_blended(void) {
  BlendedLayers nothing = {all_colours(0.0f), (Lanes)(0.0f)};
  nothing.colours.alpha = (Lanes)(1.0f);
  return nothing;
}

// Takes `found` in `lanes`.
static inline void replace_lanes(BlendedLayers* known, BlendedLayers found, LaneBits lanes) {
  known->colours = select_colours(known->colours, found.colours, lanes);
  known->confidence = select(known->confidence, found.confidence, lanes);
}

// Pixels of eight that come from as far: lane i reads the 4x4 texels from (x + i, y) on.
typedef struct LayerRun {
  int x, y;
  int8 lanes;
} LayerRun;

// Returns a run of the pixels in `lanes`, of which there is one.
static inline LayerRun find_run(const LayerSources* from, int8 lanes) {
  const int8 none = (int8)(INT_MIN);
  const int8 first_x = from->x - LANE_NUMBERS;  // where the run of each lane begins
  LayerRun run;
  run.x = largest_lane(select(none, first_x, lanes));
  const int8 same_x = lanes & (first_x == run.x);
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
  const LayerRow row = load_layer_row(past, depth, windows, 0);
  const LayerTaps taps = taps_of(&row, 0, wishes, LANES_OF(from->was_split));
  return take_taps(&taps);
}

// The weights of four taps on an axis.
typedef struct TapWeights {
  Lanes w0, w1, w2, w3;
} TapWeights;

static inline TapWeights weights_of(float8 fraction) {
  const Cubic cubic = cubic_weights(fraction, HISTORY_SHARPNESS);
  const TapWeights weights = {LANES_OF(cubic.w0), LANES_OF(cubic.w1), LANES_OF(cubic.w2), LANES_OF(cubic.w3)};
  return weights;
}

// Returns the weights with the second tap's as the first, and the first one's as the last.
static inline TapWeights next_taps(TapWeights w) {
  const TapWeights next = {w.w1, w.w2, w.w3, w.w0};
  return next;
}

// Resamples the layers of a run, or copies them.
static inline BlendedLayers sample_layers(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes,
                                          const LayerSources* from, LayerRun run) {
  const float8 zero = (float8)(0.0f);
  const bool copied = !any_lane(run.lanes & ((from->fraction_x > zero) | (from->fraction_y > zero)));
  if (copied) return copy_layers(past, depth, wishes, from, run);
  const RowWindows windows = windows_from(past, run.x, run.y, 4, true);
  const TapWeights across = weights_of(from->fraction_x);
  TapWeights wy = weights_of(from->fraction_y);
  LayerSums sums = no_taps();
  UNROLL(4)
  for (int y = 0; y < 4; ++y) {
    const LayerRow row = load_layer_row(past, depth, windows, y);
    const Lanes linear_y = LANES_OF(middle_weight(y, from->fraction_y));
    TapWeights wx = across;
    UNROLL(4)
    for (int x = 0; x < 4; ++x) {
      const LayerTaps taps = taps_of(&row, x, wishes, LANES_OF(from->was_split));
      add_taps(&sums, &taps, wx.w0 * wy.w0);
      if (is_middle_tap(x) && is_middle_tap(y))
        add_middle_taps(&sums, &taps, LANES_OF(middle_weight(x, from->fraction_x)) * linear_y);
      wx = next_taps(wx);
    }
    wy = next_taps(wy);
  }
  const LaneBits is_alone = wishes->kind == kFarLayer ? ~LANES_OF(wishes->is_split) : (LaneBits)(0);
  const BlendedLayers blended = {blend_colours(&sums), blend_confidence(&sums, is_alone)};
  return blended;
}

// Whether the places are eight texels of a row, side by side, all inside.
static inline bool lie_side_by_side(const PastLayers* past, const LayerSources* from) {
  const int8 other = (from->x - LANE_NUMBERS != from->x.s0) | (from->y != from->y.s0);
  if (any_lane(other | from->is_outside | (from->fraction_x > 0.0f) | (from->fraction_y > 0.0f))) return false;
  return from->x.s0 >= -1 && from->x.s0 + 1 + kTemporalTile <= past->far.width;
}

// Whether none of those has two layers.
static inline bool have_one(const PastLayers* past, const LayerSources* from) {
  const EightTexels texels = load_history_lanes(past->far, (from->y.s0 + 1) * past->far.width + from->x.s0 + 1);
  return !any_lane(as_int8(confidences(texels)) >> 31);
}

// Fetches surfaces alone among texels of one layer, as resolve_temporal does.
static inline KnownLayers fetch_alone(const PastLayers* past, const LayerSources* from, bool copied) {
  const SourcePlaces places = {{from->x, from->fraction_x}, {from->y, from->fraction_y}};
  const FetchedHistory history =
      copied ? copy_history(past->far, from->x.s0 + 1, from->y.s0 + 1) : resample_history(past->far, places);
  const float8 coverage = select((float8)(1.0f), (float8)(0.0f), from->is_outside);
  KnownLayers known = {history.texels, history.confidence, (float8)(1.0f)};
  known.texels.left.s37bf = coverage.lo;
  known.texels.right.s37bf = coverage.hi;
#if ALPHA
  known.alpha = resample_alpha(past->alpha, places);
#endif
  return known;
}

static inline float16 four_texels(float4 red, float4 green, float4 blue, float4 last) {
  return (float16)(red.x, green.x, blue.x, last.x, red.y, green.y, blue.y, last.y, red.z, green.z, blue.z, last.z,
                   red.w, green.w, blue.w, last.w);
}

// Samples the layers of the pixels in `left`, run by run; of the others nothing.
static inline KnownLayers sample_lanes(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes,
                                       const LayerSources* from, int8 left) {
  BlendedLayers found = nothing_blended();
  while (any_lane(left)) {
    const LayerRun run = find_run(from, left);
    replace_lanes(&found, sample_layers(past, depth, wishes, from, run), LANES_OF(run.lanes));
    left &= ~run.lanes;
    if (!ON_CPU) break;  // one lane means one run; compilers cannot prove it
  }
  const LayerColours c = found.colours;
#if ON_CPU
  const EightTexels texels = {four_texels(c.red.lo, c.green.lo, c.blue.lo, c.coverage.lo),
                              four_texels(c.red.hi, c.green.hi, c.blue.hi, c.coverage.hi)};
#else
  const EightTexels texels = push_texel(no_texels(), (float4)(c.red, c.green, c.blue, c.coverage));
#endif
  const KnownLayers known = {texels, (float8)(found.confidence), (float8)(c.alpha)};
  return known;
}

// Fetches the wanted layers of the pixels in `lanes`; of the others nothing.
static inline KnownLayers fetch_layers(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes,
                                       const LayerSources* from, int8 lanes) {
  if (wishes->kind == kFarLayer && !any_lane(wishes->is_split)) {
    const bool copied = lie_side_by_side(past, from);
    if ((copied && have_one(past, from)) || !may_meet_two(past, from)) return fetch_alone(past, from, copied);
  }
  return sample_lanes(past, depth, wishes, from, lanes & ~from->is_outside);
}
