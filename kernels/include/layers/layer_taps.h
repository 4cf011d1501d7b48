// SPDX-License-Identifier: MIT
// Taps: value, coverage and confidence that texels of history have for the layer that a pixel wants, one texel of each
// pixel of a row at a time; and their sums over the 4x4 texels around the pixels' places.
#pragma once

#include "layers/constants.h"
#include "layers/past_layers.h"
#include "temporal/constants.h"

// Layers of history that pixels want.
typedef struct LayerWishes {
  LayerKind kind;
  LaneMask is_split;             // lanes with two layers
  LaneFloat near_depth, far_depth;  // for a surface alone its own depth and any
  float least_part, most_part;   // fractions of a near layer's depth: texels within that range show the same thing
} LayerWishes;

// Colours and alphas, times coverages, and coverages, by channel.
typedef struct LayerColours {
  LaneFloat red, green, blue, coverage;
  LaneFloat alpha;  // with ALPHA
} LayerColours;

// One texel of each pixel as the layer has it.
typedef struct LayerTaps {
  LayerColours colours;
  LaneFloat confidence;
  LaneMask has_two;  // it has two layers
  LaneMask valid;    // it has the surface that is wished for, or says that nothing of it is there
} LayerTaps;

static inline LaneMask are_alike(LaneFloat a, LaneFloat b, float tolerance) {
  return fabs(a - b) <= tolerance * max(a, b);
}

// Looks for far layers, and for surfaces alone, in a column of the pixels' neighbourhoods. `tests_depth`: lanes of
// surfaces alone whose texels of one layer must not be nearer, as no trust tells.
static inline LayerTaps far_taps(const LayerRow* row, int column, const LayerWishes* wishes, LaneMask tests_depth) {
  const LaneFloat far_depth = in_column(row->far_depth, column), near_depth = in_column(row->near_depth, column);
  const LaneFloat stored = in_column(row->far.last, column), coverage = in_column(row->near.last, column);
  const LaneFloat confidence = min(fabs(stored), CONFIDENCE_MAX);
  const LaneMask split = wishes->is_split, two = as_lane_int(stored) < 0;
  const LaneFloat wanted = select(wishes->near_depth, wishes->far_depth, split);
  const LaneMask is_near = two & (wanted > 0.5f * (far_depth + near_depth));
  const LaneFloat shown = select(far_depth, near_depth, is_near);
  const LaneMask known = confidence > 0.0f;

  const LaneMask far_valid = (shown >= wanted * (1.0f - FAR_DEPTH_STEP_MAX)) &
                         (shown <= 0.5f * (wishes->near_depth + wishes->far_depth)) &
                         select(known, coverage >= NEAR_COVERAGE_MIN, is_near);
  const LaneMask alone_valid = select(mask_not(tests_depth) | (far_depth <= wanted * (1.0f + FAR_DEPTH_STEP_MAX)),
                                  select(known & are_alike(shown, wanted, FAR_DEPTH_STEP_MAX),
                                         are_alike(shown, wanted, NEAR_DEPTH_STEP_MAX), is_near), two);

  // Behind another surface the coverage of a near layer does not matter.
  const LaneFloat whole = select((LaneFloat)(1.0f), 1.0f / max(coverage, (LaneFloat)(NEAR_COVERAGE_MIN)), split);
  LayerTaps taps;
  taps.colours.red = select(in_column(row->far.red, column), in_column(row->near.red, column) * whole, is_near);
  taps.colours.green = select(in_column(row->far.green, column), in_column(row->near.green, column) * whole, is_near);
  taps.colours.blue = select(in_column(row->far.blue, column), in_column(row->near.blue, column) * whole, is_near);
  taps.colours.coverage = select((LaneFloat)(1.0f), coverage, is_near & mask_not(split));
  taps.colours.alpha = (LaneFloat)(0.0f);
  if (ALPHA)
    taps.colours.alpha = select(in_column(row->alpha, column), in_column(row->near_alpha, column) * whole, is_near);
  taps.confidence = select(confidence, in_column(row->near_confidence, column) * coverage, is_near);
  taps.has_two = two;
  taps.valid = select(alone_valid, far_valid, split);
  return taps;
}

// Looks for near layers.
static inline LayerTaps near_taps(const LayerRow* row, int column, const LayerWishes* wishes) {
  const LaneFloat far_depth = in_column(row->far_depth, column), near_depth = in_column(row->near_depth, column);
  const LaneFloat stored = in_column(row->far.last, column);
  const LaneFloat confidence = min(fabs(stored), CONFIDENCE_MAX);
  const LaneMask two = as_lane_int(stored) < 0;
  const LaneMask is_near = two & (wishes->near_depth > 0.5f * (far_depth + near_depth));
  const LaneFloat shown = select(far_depth, near_depth, is_near);
  const LaneMask is_ours = (shown > 0.5f * (wishes->near_depth + wishes->far_depth)) &
                       (shown >= wishes->near_depth * wishes->least_part);
  const LaneFloat none = (LaneFloat)(0.0f), empty = min(confidence, EMPTY_CONFIDENCE_MAX);
  const LayerChannels *far = &row->far, *near = &row->near;

  LayerTaps taps;
  taps.colours.red = select(none, select(in_column(far->red, column), in_column(near->red, column), is_near), is_ours);
  taps.colours.green =
      select(none, select(in_column(far->green, column), in_column(near->green, column), is_near), is_ours);
  taps.colours.blue =
      select(none, select(in_column(far->blue, column), in_column(near->blue, column), is_near), is_ours);
  taps.colours.coverage = select(none, select((LaneFloat)(1.0f), in_column(near->last, column), is_near), is_ours);
  taps.colours.alpha = none;
  if (ALPHA)
    taps.colours.alpha =
        select(none, select(in_column(row->alpha, column), in_column(row->near_alpha, column), is_near), is_ours);
  taps.confidence = select(select(empty, confidence, is_ours & mask_not(two)), in_column(row->near_confidence, column),
                           is_ours & is_near);
  taps.has_two = two;
  taps.valid = shown <= wishes->near_depth * wishes->most_part;  // nothing stood before it
  return taps;
}

static inline LayerTaps taps_of(const LayerRow* row, int column, const LayerWishes* wishes, LaneMask was_split) {
  return wishes->kind == kNearLayer ? near_taps(row, column, wishes) : far_taps(row, column, wishes, was_split);
}

// ---- Sums.

typedef struct LayerSums {
  LayerColours cubic, bilinear;  // over the valid taps
  LayerColours least, most;      // range of the valid ones of the middle four
  LaneFloat weight, middle_weight;  // sums over the valid taps
  LaneFloat confidence;             // bilinear; an invalid tap is not known
  // Confidence of all taps as it is stored, for pixels without a texel of two layers.
  LaneFloat stored, least_stored, most_stored;
  LaneMask has_two;             // a tap has two layers
} LayerSums;

static inline LayerColours all_colours(float value) {
  const LaneFloat all = (LaneFloat)(value);
  const LayerColours colours = {all, all, all, all, all};
  return colours;
}

static inline LayerSums no_taps(void) {
  const LaneFloat none = (LaneFloat)(0.0f);
  const LayerSums sums = {all_colours(0.0f), all_colours(0.0f), all_colours(FLT_MAX), all_colours(-FLT_MAX),
                          none, none, none, none, (LaneFloat)(FLT_MAX), (LaneFloat)(-FLT_MAX), mask_of(false)};
  return sums;
}

static inline void add_colours(LayerColours* sum, const LayerColours* colours, LaneFloat weight) {
  sum->red += colours->red * weight;
  sum->green += colours->green * weight;
  sum->blue += colours->blue * weight;
  sum->coverage += colours->coverage * weight;
#if ALPHA
  sum->alpha += colours->alpha * weight;
#endif
}

// Takes `chosen` in `lanes`, `otherwise` in the others.
static inline LayerColours select_colours(LayerColours otherwise, LayerColours chosen, LaneMask lanes) {
  const LayerColours colours = {
      select(otherwise.red, chosen.red, lanes), select(otherwise.green, chosen.green, lanes),
      select(otherwise.blue, chosen.blue, lanes), select(otherwise.coverage, chosen.coverage, lanes),
      select(otherwise.alpha, chosen.alpha, lanes)};
  return colours;
}

static inline LayerColours min_colours(LayerColours a, LayerColours b) {
  const LayerColours colours = {min(a.red, b.red), min(a.green, b.green), min(a.blue, b.blue),
                                min(a.coverage, b.coverage), min(a.alpha, b.alpha)};
  return colours;
}

static inline LayerColours max_colours(LayerColours a, LayerColours b) {
  const LayerColours colours = {max(a.red, b.red), max(a.green, b.green), max(a.blue, b.blue),
                                max(a.coverage, b.coverage), max(a.alpha, b.alpha)};
  return colours;
}

// Adds a texel of each pixel with its weight in the cubic.
static inline void add_taps(LayerSums* sums, const LayerTaps* taps, LaneFloat weight) {
  const LaneFloat counted = select((LaneFloat)(0.0f), weight, taps->valid);
  add_colours(&sums->cubic, &taps->colours, counted);
  sums->weight += counted;
  sums->stored += taps->confidence * weight;
  sums->has_two |= taps->has_two;
}

// Adds one of the middle four, too, with its weight in the bilinear blend.
static inline void add_middle_taps(LayerSums* sums, const LayerTaps* taps, LaneFloat weight) {
  const LaneMask valid = taps->valid;
  const LaneFloat counted = select((LaneFloat)(0.0f), weight, valid);
  add_colours(&sums->bilinear, &taps->colours, counted);
  sums->middle_weight += counted;
  sums->confidence += taps->confidence * counted;
  sums->least_stored = min(sums->least_stored, taps->confidence);
  sums->most_stored = max(sums->most_stored, taps->confidence);
  sums->least = min_colours(sums->least, select_colours(all_colours(FLT_MAX), taps->colours, valid));
  sums->most = max_colours(sums->most, select_colours(all_colours(-FLT_MAX), taps->colours, valid));
}

// Blends one channel: the cubic, held in the range of the middle four; bilinear where the cubic has lost most of its
// weights; 0 where the middle four have lost theirs.
static inline LaneFloat blend_channel(LaneFloat cubic, LaneFloat bilinear, LaneFloat least, LaneFloat most,
                                      const LayerSums* sums) {
  const LaneFloat held = min(max(cubic / sums->weight, least), most);
  const LaneFloat blended = select(held, bilinear / sums->middle_weight, sums->weight < CUBIC_WEIGHT_MIN);
  return select(blended, (LaneFloat)(0.0f), sums->middle_weight < BILINEAR_WEIGHT_MIN);
}

static inline LayerColours blend_colours(const LayerSums* sums) {
  const LayerColours *cubic = &sums->cubic, *bilinear = &sums->bilinear, *least = &sums->least, *most = &sums->most;
  LayerColours colours;
  colours.red = blend_channel(cubic->red, bilinear->red, least->red, most->red, sums);
  colours.green = blend_channel(cubic->green, bilinear->green, least->green, most->green, sums);
  colours.blue = blend_channel(cubic->blue, bilinear->blue, least->blue, most->blue, sums);
  colours.coverage = blend_channel(cubic->coverage, bilinear->coverage, least->coverage, most->coverage, sums);
  colours.alpha = (LaneFloat)(0.0f);
  if (ALPHA) colours.alpha = blend_channel(cubic->alpha, bilinear->alpha, least->alpha, most->alpha, sums);
  return colours;
}

// Blends confidence: that of surfaces alone among texels of one layer by the cubic, as in resolve_temporal; else
// bilinear.
static inline LaneFloat blend_confidence(const LayerSums* sums, LaneMask is_alone) {
  const LaneFloat cubic = clamp(min(max(sums->stored, sums->least_stored), sums->most_stored), 0.0f, CONFIDENCE_MAX);
  const LaneFloat known = select(sums->confidence, (LaneFloat)(0.0f), sums->middle_weight < BILINEAR_WEIGHT_MIN);
  return select(known, cubic, is_alone & mask_not(sums->has_two));
}
