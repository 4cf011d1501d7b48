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
  RunFloats confidence;
} BlendedLayers;

static inline BlendedLayers nothing_blended(void) {
  BlendedLayers nothing = {all_colours(0.0f), (RunFloats)(0.0f)};
  nothing.colours.alpha = (RunFloats)(1.0f);
  return nothing;
}

// Takes `found` in `lanes`.
static inline void replace_lanes(BlendedLayers* known, BlendedLayers found, RunInts lanes) {
  known->colours = select_colours(known->colours, found.colours, lanes);
  known->confidence = select(known->confidence, found.confidence, lanes);
}

// Pixels of eight that come from as far: lane i reads the 4x4 texels from (x + i, y) on. On a GPU it is the first alone.
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
  const LayerTaps taps = taps_of(&row, 0, wishes, RUN_OF(from->was_split));
  return take_taps(&taps);
}

// Resamples the layers of a run, or copies them.
static inline BlendedLayers sample_layers(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes,
                                          const LayerSources* from, LayerRun run) {
  const float8 zero = (float8)(0.0f);
  const bool copied = !any_lane(run.lanes & ((from->fraction_x > zero) | (from->fraction_y > zero)));
  if (copied) return copy_layers(past, depth, wishes, from, run);
  const RowWindows windows = windows_from(past, run.x, run.y, 4, true);
  const Cubic across = cubic_weights(from->fraction_x, HISTORY_SHARPNESS);
  Cubic wy = cubic_weights(from->fraction_y, HISTORY_SHARPNESS);
  LayerSums sums = no_taps();
  UNROLL(4)
  for (int y = 0; y < 4; ++y) {
    const LayerRow row = load_layer_row(past, depth, windows, y);
    const RunFloats linear_y = RUN_OF(middle_weight(y, from->fraction_y));
    Cubic wx = across;
    UNROLL(4)
    for (int x = 0; x < 4; ++x) {
      const LayerTaps taps = taps_of(&row, x, wishes, RUN_OF(from->was_split));
      add_taps(&sums, &taps, RUN_OF(wx.w0 * wy.w0));
      if (is_middle_tap(x) && is_middle_tap(y))
        add_middle_taps(&sums, &taps, RUN_OF(middle_weight(x, from->fraction_x)) * linear_y);
      wx = next_taps(wx);
    }
    wy = next_taps(wy);
  }
  const RunInts is_alone = wishes->kind == kFarLayer ? ~RUN_OF(wishes->is_split) : (RunInts)(0);
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

#if ON_CPU
// Samples the layers of the pixels in `left`, run by run; of the others nothing.
static inline KnownLayers sample_lanes(const PastLayers* past, DEPTH_TEXELS depth, LayerWishes wishes,
                                       LayerSources from, int8 left) {
  BlendedLayers found = nothing_blended();
  while (any_lane(left)) {
    const LayerRun run = find_run(&from, left);
    replace_lanes(&found, sample_layers(past, depth, &wishes, &from, run), run.lanes);
    left &= ~run.lanes;
  }
  const LayerColours c = found.colours;
  const KnownLayers known = {{four_texels(c.red.lo, c.green.lo, c.blue.lo, c.coverage.lo),
                              four_texels(c.red.hi, c.green.hi, c.blue.hi, c.coverage.hi)},
                             found.confidence,
                             c.alpha};
  return known;
}
#else
// The same, pixel by pixel.
static inline KnownLayers sample_lanes(const PastLayers* past, DEPTH_TEXELS depth, LayerWishes wishes,
                                       LayerSources from, int8 left) {
  KnownLayers known = {no_texels(), (float8)(0.0f), (float8)(0.0f)};
  for (int i = 0; i < 8; ++i) {
    BlendedLayers found = nothing_blended();
    if (left.s0 != 0) {
      const LayerRun run = {from.x.s0, from.y.s0, (int8)(-1, 0, 0, 0, 0, 0, 0, 0)};
      found = sample_layers(past, depth, &wishes, &from, run);
    }
    const LayerColours c = found.colours;
    known.texels = push_texel(known.texels, (float4)(c.red, c.green, c.blue, c.coverage));
    known.confidence = (float8)(known.confidence.s1234, known.confidence.s567, found.confidence);
    known.alpha = (float8)(known.alpha.s1234, known.alpha.s567, c.alpha);
    wishes.is_split = NEXT_LANES(wishes.is_split);
    wishes.near_depth = NEXT_LANES(wishes.near_depth);
    wishes.far_depth = NEXT_LANES(wishes.far_depth);
    from.x = NEXT_LANES(from.x);
    from.y = NEXT_LANES(from.y);
    from.fraction_x = NEXT_LANES(from.fraction_x);
    from.fraction_y = NEXT_LANES(from.fraction_y);
    from.was_split = NEXT_LANES(from.was_split);
    left = NEXT_LANES(left);
  }
  return known;
}
#endif

// Fetches the wanted layers of the pixels in `lanes`; of the others nothing.
static inline KnownLayers fetch_layers(const PastLayers* past, DEPTH_TEXELS depth, const LayerWishes* wishes,
                                       const LayerSources* from, int8 lanes) {
  if (wishes->kind == kFarLayer && !any_lane(wishes->is_split)) {
    const bool copied = lie_side_by_side(past, from);
    if ((copied && have_one(past, from)) || !may_meet_two(past, from)) return fetch_alone(past, from, copied);
  }
  return sample_lanes(past, depth, *wishes, *from, lanes & ~from->is_outside);
}
