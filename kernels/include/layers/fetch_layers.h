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
    if (!ON_CPU) break;  // it was the only one, which compilers do not see
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
