// SPDX-License-Identifier: MIT
// Fetching a layer of eight pixels of a row where texels of history may have two.
#pragma once

#include "layers/layer_sources.h"
#include "layers/layer_sums.h"
#include "temporal/alpha.h"

// What is fetched of eight pixels.
typedef struct FetchedLayers {
  EightTexels texels;  // premultiplied colours and coverages
  float8 confidence;   // 0: nothing is known
  float8 alpha;        // 1 without ALPHA
} FetchedLayers;

// The same by channel.
typedef struct BlendedLayers {
  LayerColours colours;
  float8 confidence;
} BlendedLayers;

static inline LayerTaps taps_of(const EightLayers* texels, const LayerWishes* wishes, int8 was_split) {
  return wishes->kind == kNearLayer ? near_taps(texels, wishes) : far_taps(texels, wishes, was_split);
}

static inline LayerTaps taps_of_row(const LayerRow* row, int column, const LayerWishes* wishes, int8 was_split) {
  const EightLayers texels = eight_of_row(row, column);
  return taps_of(&texels, wishes, was_split);
}

// At places that lie on texels, of the first of eight on (x, y).
static inline BlendedLayers copy_layers(const PastLayers* past, DEPTH_TEXELS depth, TexelLayout layout,
                                        const LayerWishes* wishes, const LayerSources* from, int x, int y) {
  const EightLayers texels = load_eight_layers(past, depth, layout, x, y);
  const LayerTaps taps = taps_of(&texels, wishes, from->was_split);
  const float8 none = (float8)(0.0f);
  const BlendedLayers copied = {{select(none, taps.red, taps.valid), select(none, taps.green, taps.valid),
                                 select(none, taps.blue, taps.valid), select(none, taps.coverage, taps.valid),
                                 select((float8)(1.0f), taps.alpha, taps.valid)},
                                select(none, taps.confidence, taps.valid)};
  return copied;
}

// Adds a row of the 4x4 texels around each place, of weight wy in the cubic and, if it is one of the middle two,
// linear_y in the bilinear blend.
static inline void add_row(LayerSums* sums, const LayerRow* row, const LayerWishes* wishes, const LayerSources* from,
                           Cubic wx, float8 wy, float8 linear_y, bool is_middle) {
  const LayerTaps taps0 = taps_of_row(row, 0, wishes, from->was_split);
  add_taps(sums, &taps0, wx.w0 * wy);
  const LayerTaps taps1 = taps_of_row(row, 1, wishes, from->was_split);
  add_taps(sums, &taps1, wx.w1 * wy);
  if (is_middle) add_middle_taps(sums, &taps1, (1.0f - from->fraction_x) * linear_y);
  const LayerTaps taps2 = taps_of_row(row, 2, wishes, from->was_split);
  add_taps(sums, &taps2, wx.w2 * wy);
  if (is_middle) add_middle_taps(sums, &taps2, from->fraction_x * linear_y);
  const LayerTaps taps3 = taps_of_row(row, 3, wishes, from->was_split);
  add_taps(sums, &taps3, wx.w3 * wy);
}

// Of the pixels in `lanes`, which all come from as far: of the first of eight, (x, y) is the first of the 4x4 texels.
static inline BlendedLayers sample_layers(const PastLayers* past, DEPTH_TEXELS depth, TexelLayout layout,
                                          const LayerWishes* wishes, const LayerSources* from, int8 lanes, int x,
                                          int y) {
  const float8 zero = (float8)(0.0f);
  if (!any_lane(lanes & ((from->fraction_x > zero) | (from->fraction_y > zero))))
    return copy_layers(past, depth, layout, wishes, from, x + 1, y + 1);
  const RowWindows windows = windows_from(past, x, y, 4);
  const Cubic wx = cubic_weights(from->fraction_x, HISTORY_SHARPNESS);
  const Cubic wy = cubic_weights(from->fraction_y, HISTORY_SHARPNESS);
  LayerSums sums = no_taps();
  const LayerRow row0 = load_layer_row(past, depth, layout, &windows, 0);
  add_row(&sums, &row0, wishes, from, wx, wy.w0, zero, false);
  const LayerRow row1 = load_layer_row(past, depth, layout, &windows, 1);
  add_row(&sums, &row1, wishes, from, wx, wy.w1, 1.0f - from->fraction_y, true);
  const LayerRow row2 = load_layer_row(past, depth, layout, &windows, 2);
  add_row(&sums, &row2, wishes, from, wx, wy.w2, from->fraction_y, true);
  const LayerRow row3 = load_layer_row(past, depth, layout, &windows, 3);
  add_row(&sums, &row3, wishes, from, wx, wy.w3, zero, false);
  const int8 is_alone = wishes->kind == kFarLayer ? ~wishes->is_split : (int8)(0);
  const BlendedLayers blended = {blend_sums(&sums), blend_confidence(&sums, is_alone)};
  return blended;
}

static inline void replace_lanes(BlendedLayers* found, const BlendedLayers* by, int8 lanes) {
  LayerColours* to = &found->colours;
  const LayerColours* of = &by->colours;
  to->red = select(to->red, of->red, lanes);
  to->green = select(to->green, of->green, lanes);
  to->blue = select(to->blue, of->blue, lanes);
  to->coverage = select(to->coverage, of->coverage, lanes);
  to->alpha = select(to->alpha, of->alpha, lanes);
  found->confidence = select(found->confidence, by->confidence, lanes);
}

static inline float16 four_texels(float4 red, float4 green, float4 blue, float4 last) {
  return (float16)(red.x, green.x, blue.x, last.x, red.y, green.y, blue.y, last.y, red.z, green.z, blue.z, last.z,
                   red.w, green.w, blue.w, last.w);
}

// Whether the places are eight texels of a row, side by side, none beyond the edges.
static inline bool lie_on_a_row(const LayerSources* from) {
  const int8 other = (from->x - (int8)(0, 1, 2, 3, 4, 5, 6, 7) != from->x.s0) | (from->y != from->y.s0);
  return !any_lane(other | from->is_outside | (from->fraction_x > 0.0f) | (from->fraction_y > 0.0f));
}

// Whether the places are eight texels of a row, side by side, all inside.
static inline bool are_copied(const PastLayers* past, const LayerSources* from) {
  return lie_on_a_row(from) && from->x.s0 >= -1 && from->x.s0 + 1 + kTemporalTile <= past->far.width;
}

// Whether none of them has two layers.
static inline bool have_one(const PastLayers* past, const LayerSources* from) {
  const EightTexels texels = load_history8(past->far, (from->y.s0 + 1) * past->far.width + from->x.s0 + 1);
  return !any_lane(as_int8(confidences(texels)) >> 31);
}

// Surfaces alone among texels of one layer: as resolve_temporal has it.
static inline FetchedLayers fetch_alone(const PastLayers* past, const LayerSources* from, bool copied) {
  const SourcePlaces places = {{from->x, from->fraction_x}, {from->y, from->fraction_y}};
  const FetchedHistory history =
      copied ? copy_history(past->far, from->x.s0 + 1, from->y.s0 + 1) : resample_history(past->far, places);
  const float8 coverage = select((float8)(1.0f), (float8)(0.0f), from->is_outside);
  FetchedLayers fetched = {history.texels, history.confidence, (float8)(1.0f)};
  fetched.texels.left.s37bf = coverage.lo;
  fetched.texels.right.s37bf = coverage.hi;
#if ALPHA
  fetched.alpha = resample_alpha(past->alpha, places);
#endif
  return fetched;
}

// History of the wanted layers of the pixels in `lanes`; of the others nothing.
static inline FetchedLayers fetch_layers(const PastLayers* past, DEPTH_TEXELS depth, TexelLayout layout,
                                         const LayerWishes* wishes, const LayerSources* from, int8 lanes) {
  if (wishes->kind == kFarLayer && !any_lane(wishes->is_split)) {
    const bool copied = are_copied(past, from);
    if ((copied && have_one(past, from)) || !may_meet_two(past, from)) return fetch_alone(past, from, copied);
  }
  const int8 first_x = from->x - (int8)(0, 1, 2, 3, 4, 5, 6, 7);
  const int8 least = (int8)(INT_MIN);
  BlendedLayers found = {all_colours(0.0f), (float8)(0.0f)};
  found.colours.alpha = (float8)(1.0f);
  int8 left = lanes & ~from->is_outside;
  while (any_lane(left)) {
    const int x = largest_lane(select(least, first_x, left));
    const int8 same_x = left & (first_x == x);
    const int y = largest_lane(select(least, from->y, same_x));
    const int8 same = same_x & (from->y == y);
    const BlendedLayers blended = sample_layers(past, depth, layout, wishes, from, same, x, y);
    replace_lanes(&found, &blended, same);
    left &= ~same;
  }
  const LayerColours c = found.colours;
  const FetchedLayers fetched = {{four_texels(c.red.lo, c.green.lo, c.blue.lo, c.coverage.lo),
                                  four_texels(c.red.hi, c.green.hi, c.blue.hi, c.coverage.hi)},
                                 found.confidence,
                                 c.alpha};
  return fetched;
}
