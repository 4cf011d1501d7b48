// SPDX-License-Identifier: MIT
// Fetching a layer of eight pixels of a row where texels of history may have two.
#pragma once

#include "bits.h"
#include "layers/layer_sources.h"
#include "layers/layer_taps.h"
#include "temporal/constants.h"
#include "temporal/fetch_history.h"

// A layer of eight pixels as far as it is known.
typedef struct KnownLayers {
  EightTexels texels;  // premultiplied colours and coverages
  float8 confidence;   // 0: nothing is known
  float8 alpha;        // 1 without ALPHA
} KnownLayers;

// The same by channel.
typedef struct BlendedLayers {
  LayerColours colours;
  float8 confidence;
} BlendedLayers;

static inline BlendedLayers nothing_blended(void) {
  BlendedLayers nothing = {all_colours(0.0f), (float8)(0.0f)};
  nothing.colours.alpha = (float8)(1.0f);
  return nothing;
}

// Takes `found` in `lanes`.
static inline void replace_lanes(BlendedLayers* known, BlendedLayers found, int8 lanes) {
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
  const int8 first_x = from->x - (int8)(0, 1, 2, 3, 4, 5, 6, 7);  // where the run of each lane begins
  LayerRun run;
  run.x = largest_lane(select(none, first_x, lanes));
  const int8 same_x = lanes & (first_x == run.x);
  run.y = largest_lane(select(none, from->y, same_x));
  run.lanes = same_x & (from->y == run.y);
  return run;
}

// Copies the layers of a run whose places lie on texels.
static inline BlendedLayers copy_layers(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes,
                                        const LayerSources* from, LayerRun run) {
  const RowWindows windows = windows_from(past, run.x + 1, run.y + 1, 1, false);
  const LayerRow row = load_layer_row(past, depth, &windows, 0);
  const LayerTaps taps = taps_of(&row, 0, wishes, from->was_split);
  const BlendedLayers found = {taps.colours, taps.confidence};
  BlendedLayers copied = nothing_blended();
  replace_lanes(&copied, found, taps.valid);
  return copied;
}

// Adds a row of the 4x4 texels around each place, of weight wy in the cubic and, if it is one of the middle two,
// linear_y in the bilinear blend.
static inline void add_row(LayerSums* sums, const LayerRow* row, const LayerWishes* wishes, const LayerSources* from,
                           Cubic wx, float8 wy, float8 linear_y, bool is_middle) {
  const LayerTaps taps0 = taps_of(row, 0, wishes, from->was_split);
  add_taps(sums, &taps0, wx.w0 * wy);
  const LayerTaps taps1 = taps_of(row, 1, wishes, from->was_split);
  add_taps(sums, &taps1, wx.w1 * wy);
  if (is_middle) add_middle_taps(sums, &taps1, (1.0f - from->fraction_x) * linear_y);
  const LayerTaps taps2 = taps_of(row, 2, wishes, from->was_split);
  add_taps(sums, &taps2, wx.w2 * wy);
  if (is_middle) add_middle_taps(sums, &taps2, from->fraction_x * linear_y);
  const LayerTaps taps3 = taps_of(row, 3, wishes, from->was_split);
  add_taps(sums, &taps3, wx.w3 * wy);
}

// Resamples the layers of a run.
static inline BlendedLayers sample_layers(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes,
                                          const LayerSources* from, LayerRun run) {
  const float8 zero = (float8)(0.0f);
  if (!any_lane(run.lanes & ((from->fraction_x > zero) | (from->fraction_y > zero))))
    return copy_layers(past, depth, wishes, from, run);
  const RowWindows windows = windows_from(past, run.x, run.y, 4, true);
  const Cubic wx = cubic_weights(from->fraction_x, HISTORY_SHARPNESS);
  const Cubic wy = cubic_weights(from->fraction_y, HISTORY_SHARPNESS);
  LayerSums sums = no_taps();
  const LayerRow row0 = load_layer_row(past, depth, &windows, 0);
  add_row(&sums, &row0, wishes, from, wx, wy.w0, zero, false);
  const LayerRow row1 = load_layer_row(past, depth, &windows, 1);
  add_row(&sums, &row1, wishes, from, wx, wy.w1, 1.0f - from->fraction_y, true);
  const LayerRow row2 = load_layer_row(past, depth, &windows, 2);
  add_row(&sums, &row2, wishes, from, wx, wy.w2, from->fraction_y, true);
  const LayerRow row3 = load_layer_row(past, depth, &windows, 3);
  add_row(&sums, &row3, wishes, from, wx, wy.w3, zero, false);
  const int8 is_alone = wishes->kind == kFarLayer ? ~wishes->is_split : (int8)(0);
  const BlendedLayers blended = {blend_colours(&sums), blend_confidence(&sums, is_alone)};
  return blended;
}

// Whether the places are eight texels of a row, side by side, all inside.
static inline bool lie_side_by_side(const PastLayers* past, const LayerSources* from) {
  const int8 other = (from->x - (int8)(0, 1, 2, 3, 4, 5, 6, 7) != from->x.s0) | (from->y != from->y.s0);
  if (any_lane(other | from->is_outside | (from->fraction_x > 0.0f) | (from->fraction_y > 0.0f))) return false;
  return from->x.s0 >= -1 && from->x.s0 + 1 + kTemporalTile <= past->far.width;
}

// Whether none of those has two layers.
static inline bool have_one(const PastLayers* past, const LayerSources* from) {
  const EightTexels texels = load_history8(past->far, (from->y.s0 + 1) * past->far.width + from->x.s0 + 1);
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

// Fetches the wanted layers of the pixels in `lanes`; of the others nothing.
static inline KnownLayers fetch_layers(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes,
                                       const LayerSources* from, int8 lanes) {
  if (wishes->kind == kFarLayer && !any_lane(wishes->is_split)) {
    const bool copied = lie_side_by_side(past, from);
    if ((copied && have_one(past, from)) || !may_meet_two(past, from)) return fetch_alone(past, from, copied);
  }
  BlendedLayers found = nothing_blended();
  int8 left = lanes & ~from->is_outside;
  while (any_lane(left)) {
    const LayerRun run = find_run(from, left);
    replace_lanes(&found, sample_layers(past, depth, wishes, from, run), run.lanes);
    left &= ~run.lanes;
  }
  const LayerColours c = found.colours;
  const KnownLayers known = {{four_texels(c.red.lo, c.green.lo, c.blue.lo, c.coverage.lo),
                              four_texels(c.red.hi, c.green.hi, c.blue.hi, c.coverage.hi)},
                             found.confidence,
                             c.alpha};
  return known;
}
