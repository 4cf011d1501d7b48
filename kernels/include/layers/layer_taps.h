// SPDX-License-Identifier: MIT
// What texels of history have of a layer: a row of four at a time.
#pragma once

#include "layers/past_layers.h"

#define NEAR_DEPTHS 0.1f    // of the larger depth: a near layer of another depth is another thing's
#define FAR_DEPTHS 0.2f     // the same of a far layer, which may be seen at a slant
#define SOLID 0.3f          // coverage from which a near layer may stand for a surface alone
#define EMPTY_CONFIDENCE 1.0f  // at most: that there is no near layer where there was but one

// What a pixel wants of history.
typedef enum LayerKind {
  kOneLayer,   // a surface of depth `near_depth`, alone
  kFarLayer,   // the one of depth `far_depth` behind another
  kNearLayer,  // the one of depth `near_depth` before another
} LayerKind;

typedef struct LayerWish {
  LayerKind kind;
  float near_depth, far_depth;
  bool tests_depth;  // of one layer: texels of one layer must not be nearer, as no trust tells
} LayerWish;

// Four texels of a row as a layer has them: premultiplied colours and coverages, confidences, and whether they are the
// surface that is wished for.
typedef struct LayerTaps {
  float16 value;
  float4 confidence;
  float4 alpha;  // with ALPHA: of the far layer; a near one is opaque where it covers
  int4 valid;
} LayerTaps;

// The states of four texels.
typedef struct LayerStates {
  float4 far_depth, near_depth, near_confidence;
} LayerStates;

// Some rows of four texels from (x, y) on, which may be anywhere.
typedef struct TapWindow {
  int x, y;
  bool is_inside;   // all of them are
  bool has_states;  // all of them have been stored
} TapWindow;

static inline TapWindow window_at(const PastLayers* past, int x, int y, int rows) {
  TapWindow window = {x, y, false, false};
  window.is_inside = x >= 0 && y >= 0 && x + 4 <= past->far.width && y + rows <= past->far.height;
  if (!window.is_inside) return window;
  const int left = x / kTemporalTile, right = (x + 3) / kTemporalTile;
  __global const LayerTile* upper = past->layer_tiles + y / kTemporalTile * past->tiles_x;
  __global const LayerTile* lower = past->layer_tiles + (y + rows - 1) / kTemporalTile * past->tiles_x;
  window.has_states =
      (upper[left].is_layered & upper[right].is_layered & lower[left].is_layered & lower[right].is_layered) != 0;
  return window;
}

// Of a row of the window.
static inline LayerStates states_of_row(const PastLayers* past, DEPTH_TEXELS depth, TexelLayout layout,
                                        TapWindow window, int row) {
  LayerStates states;
  const int x = window.x;
  const int y = window.is_inside ? window.y + row : clamp(window.y + row, 0, past->far.height - 1);
  if (window.has_states) {
    const float16 stored = load_half_texels4(past->states, y * past->far.width + x);
    const float4 far = stored.s048c * stored.s048c, near = stored.s159d * stored.s159d;
    states.far_depth = far * far;
    states.near_depth = near * near;
    states.near_confidence = stored.s26ae;
    return states;
  }
  LayerState state[4];
  for (int i = 0; i < 4; ++i)
    state[i] = state_at(past, depth, layout, clamp(x + i, 0, past->far.width - 1), y);
  states.far_depth = (float4)(state[0].far_depth, state[1].far_depth, state[2].far_depth, state[3].far_depth);
  states.near_depth = (float4)(state[0].near_depth, state[1].near_depth, state[2].near_depth, state[3].near_depth);
  states.near_confidence = (float4)(state[0].near_confidence, state[1].near_confidence, state[2].near_confidence,
                                    state[3].near_confidence);
  return states;
}

static inline int4 are_alike(float4 a, float4 b, float tolerance) {
  return fabs(a - b) <= tolerance * max(a, b);
}

static inline float16 with_coverage(float16 colours, float coverage) {
  const int16 last = (int16)(0, 0, 0, -1, 0, 0, 0, -1, 0, 0, 0, -1, 0, 0, 0, -1);
  return select(colours, (float16)(coverage), last);
}

static inline int16 to_four_masks(int4 lanes) {
  return (int16)((int4)(lanes.x), (int4)(lanes.y), (int4)(lanes.z), (int4)(lanes.w));
}

// A row of the window, clamped to the edge.
static inline float16 load_row(HistoryLayer layer, TapWindow window, int row) {
  return window.is_inside ? load_history4(layer, (window.y + row) * layer.width + window.x)
                          : load_clamped4(layer, window.x, window.y + row);
}

static inline float4 alpha_of_row(AlphaPlane plane, TapWindow window, int row) {
#if ALPHA
  return load_alpha_clamped4(plane, window.x, window.y + row);
#else
  return (float4)(1.0f);
#endif
}

// What the wish finds in a row of the window.
static inline LayerTaps taps_of_row(const PastLayers* past, DEPTH_TEXELS depth, TexelLayout layout, LayerWish wish,
                                    TapWindow window, int row) {
  const float16 far = load_row(past->far, window, row);
  const float4 stored = far.s37bf;
  const int4 two = as_int4(stored) < 0;
  LayerTaps taps;
  taps.value = with_coverage(far, 1.0f);
  taps.confidence = min(fabs(stored), MOST_CONFIDENCE);
  taps.alpha = alpha_of_row(past->alpha, window, row);
  taps.valid = (int4)(-1);
  const bool any_two = any(two);
  if (wish.kind == kOneLayer && !any_two && !wish.tests_depth) return taps;

  const LayerStates states = states_of_row(past, depth, layout, window, row);
  const float4 between = 0.5f * (states.far_depth + states.near_depth);
  float16 near = (float16)(0.0f);
  if (any_two) near = load_row(past->near, window, row);
  const float4 coverage = near.s37bf;
  const float4 near_depth = (float4)(wish.near_depth), far_depth = (float4)(wish.far_depth);
  const float4 wished_between = 0.5f * (near_depth + far_depth);
  const int4 known = taps.confidence > 0.0f;
  if (wish.kind == kOneLayer) {
    const int4 is_near = two & (near_depth > between);
    taps.value = select(taps.value, near, to_four_masks(is_near));
    const int4 valid = select(known & are_alike(states.far_depth, near_depth, FAR_DEPTHS),
                              are_alike(states.near_depth, near_depth, NEAR_DEPTHS), is_near);
    taps.confidence = select(taps.confidence, states.near_confidence * coverage, is_near);
    taps.alpha = select(taps.alpha, (float4)(1.0f), is_near);
    int4 alone = (int4)(-1);
    if (wish.tests_depth) alone = states.far_depth <= near_depth * (1.0f + FAR_DEPTHS);
    taps.valid = select(alone, valid, two);
  } else if (wish.kind == kFarLayer) {
    const float4 least = far_depth * (1.0f - FAR_DEPTHS);
    const int4 is_near = two & (far_depth > between);
    const float16 solid = with_coverage(near / to_four_texels(max(coverage, (float4)(SOLID))), 1.0f);
    const float4 shown = select(states.far_depth, states.near_depth, is_near);
    taps.value = select(taps.value, solid, to_four_masks(is_near));
    taps.confidence = select(taps.confidence, states.near_confidence * coverage, is_near);
    taps.alpha = select(taps.alpha, (float4)(1.0f), is_near);
    taps.valid = select(known, coverage >= SOLID, is_near) & (shown >= least) & (shown <= wished_between);
  } else {
    const int4 is_near = two & (near_depth > between);
    const float4 shown = select(states.far_depth, states.near_depth, is_near);
    const int4 is_ours = shown > wished_between;
    const float4 little = min(taps.confidence, EMPTY_CONFIDENCE);
    taps.value = select((float16)(0.0f), select(taps.value, near, to_four_masks(is_near)), to_four_masks(is_ours));
    taps.confidence = select(select(little, taps.confidence, is_ours & ~two), states.near_confidence,
                             is_ours & is_near);
    taps.valid = shown <= near_depth * (1.0f + NEAR_DEPTHS);  // nothing stood before it
  }
  return taps;
}
