// SPDX-License-Identifier: MIT
// Fetching history of one pixel where texels may have two layers.
#pragma once

#include "layers/layer.h"
#include "temporal/fetch_history.h"
#include "temporal/history_alpha.h"

#define LAYER_COPIED 0.06f  // texels: a place of a rigid layer this near to a texel is that texel
#define NEAR_DEPTHS 0.1f    // of the larger depth: a near layer of another depth is another thing's
#define FAR_DEPTHS 0.2f     // the same of a far layer, which may be seen at a slant
#define SOLID 0.3f          // coverage from which a near layer may stand for a surface alone
#define EMPTY_CONFIDENCE 1.0f  // at most: that there is no near layer where there was but one
#define LEAST_TAPS 0.5f     // of the weights of all taps: less is no cubic any more
#define NO_TAPS 1e-3f

// The previous frame's layers.
typedef struct PastLayers {
  HistoryLayer far;                        // colour and confidence
  AlphaPlane alpha;                        // with ALPHA: the far layer's
  HistoryLayer near;                       // premultiplied colour and coverage
  __global const half* states;             // see LayerState
  __global const TileReprojection* tiles;  // of the far layer
  __global const LayerTile* layer_tiles;
  int tiles_x, tiles_y;
  // Where the samples of that frame lie: sample i at (i * spacing + start), output pixels.
  int width, height;
  float2 spacing, start;
} PastLayers;

// What a texel is, besides its colours. The confidence of a texel of two layers is stored with a minus sign, even 0.
// The rest is stored in layered tiles only, in four halves, depths as fourth roots: so a half holds them to .2 %.
typedef struct LayerState {
  float far_depth;        // of what the far layer, or the only one, shows
  float near_depth;       // 0: there is one layer
  float near_confidence;
} LayerState;

static inline float between_layers(LayerState state) {
  return 0.5f * (state.far_depth + state.near_depth);
}

static inline LayerState load_state(__global const half* states, int index) {
  const float4 stored = vload_half4(index, states);
  const float4 squared = stored * stored;
  const LayerState state = {squared.x * squared.x, squared.y * squared.y, stored.z};
  return state;
}

// The first `count` of eight.
static inline void store_states(__global half* states, int index, int count, float8 far_depth, float8 near_depth,
                                float8 near_confidence) {
  const float8 far = sqrt(sqrt(far_depth)), near = sqrt(sqrt(near_depth));
  const float16 left = (float16)(far.s0, near.s0, near_confidence.s0, 0.0f, far.s1, near.s1, near_confidence.s1, 0.0f,
                                 far.s2, near.s2, near_confidence.s2, 0.0f, far.s3, near.s3, near_confidence.s3, 0.0f);
  const float16 right = (float16)(far.s4, near.s4, near_confidence.s4, 0.0f, far.s5, near.s5, near_confidence.s5, 0.0f,
                                  far.s6, near.s6, near_confidence.s6, 0.0f, far.s7, near.s7, near_confidence.s7, 0.0f);
  if (count >= 8) {
    store_half_texels4(states, index, left);
    store_half_texels4(states, index + 4, right);
    return;
  }
  float4 state[8];
  vstore16(left, 0, (float*)state);
  vstore16(right, 1, (float*)state);
  for (int i = 0; i < count; ++i) vstore_half4_rte(state[i], index + i, states);
}

static inline int layer_tile_at(const PastLayers* past, int x, int y) {
  const int tile_x = clamp(x / kTemporalTile, 0, past->tiles_x - 1);
  const int tile_y = clamp(y / kTemporalTile, 0, past->tiles_y - 1);
  return tile_y * past->tiles_x + tile_x;
}

// Of texel (x, y). Where nothing was stored, it shows what the sample nearest to its picture does.
static inline LayerState state_at(const PastLayers* past, DEPTH_TEXELS depth, TexelLayout layout, int x, int y) {
  const int tile = layer_tile_at(past, x, y);
  if (past->layer_tiles[tile].is_layered) return load_state(past->states, y * past->far.width + x);
  const float2 phase = (float2)(past->tiles[tile].phase_x, past->tiles[tile].phase_y);
  const float2 place = (float2)((float)x + 0.5f, (float)y + 0.5f) + phase;
  const float2 at = floor((place - past->start) / past->spacing + 0.5f);
  const int column = clamp((int)at.x, 0, past->width - 1), row = clamp((int)at.y, 0, past->height - 1);
  const LayerState state = {load_depth(depth, layout, column, row), 0.0f, 0.0f};
  return state;
}

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

static inline Neighbourhood load_window(HistoryLayer layer, TapWindow window) {
  return window.is_inside ? load_neighbourhood(layer, window.x, window.y)
                          : load_neighbourhood_clamped(layer, window.x, window.y);
}

static inline bool has_split_texel(Neighbourhood around) {
  const int16 signs = as_int16(around.row0) | as_int16(around.row1) | as_int16(around.row2) | as_int16(around.row3);
  return any(signs.s37bf < 0);
}

static inline bool has_only_split_texels(Neighbourhood around) {
  const int16 signs = as_int16(around.row0) & as_int16(around.row1) & as_int16(around.row2) & as_int16(around.row3);
  return all(signs.s37bf < 0);
}

typedef struct LayerTexel {
  float4 value;      // premultiplied colour and coverage
  float confidence;  // 0: nothing is known
  float alpha;       // 1 without ALPHA
  float2 fraction;   // as in FetchedHistory
  bool was_split;    // the texel at that place has two layers
} LayerTexel;

static inline float4 add_four(float16 texels) {
  const float8 pair = texels.lo + texels.hi;
  return pair.lo + pair.hi;
}

static inline float sum_of(float4 value) {
  const float2 pair = value.lo + value.hi;
  return pair.x + pair.y;
}

// Sums over taps.
typedef struct TapSums {
  float16 value, middle;
  float4 weight, middle_weight, confidence;
  float8 least, most;  // of the middle columns
#if ALPHA
  float4 alpha, middle_alpha;
  float2 least_alpha, most_alpha;
#endif
} TapSums;

static inline TapSums no_taps(void) {
  const TapSums none = {(float16)(0.0f), (float16)(0.0f), (float4)(0.0f),      (float4)(0.0f),
                        (float4)(0.0f),  (float8)(FLT_MAX), (float8)(-FLT_MAX),
#if ALPHA
                        (float4)(0.0f),  (float4)(0.0f),    (float2)(FLT_MAX),   (float2)(-FLT_MAX)
#endif
  };
  return none;
}

// Adds a row with its weights of the cubic and, in the middle, of the bilinear blend; 0 elsewhere.
static inline void add_taps(TapSums* sums, const LayerTaps* taps, float4 weight, float4 middle_weight, bool is_middle) {
  const float4 counted = select((float4)(0.0f), weight, taps->valid);
  sums->value += taps->value * to_four_texels(counted);
  sums->weight += counted;
#if ALPHA
  sums->alpha += taps->alpha * counted;
#endif
  if (!is_middle) return;
  const float4 shared = select((float4)(0.0f), middle_weight, taps->valid);
  sums->middle += taps->value * to_four_texels(shared);
  sums->middle_weight += shared;
  sums->confidence += taps->confidence * shared;
  const int8 valid = to_four_masks(taps->valid).s456789ab;
  const float8 value = taps->value.s456789ab;
  sums->least = min(sums->least, select((float8)(FLT_MAX), value, valid));
  sums->most = max(sums->most, select((float8)(-FLT_MAX), value, valid));
#if ALPHA
  sums->middle_alpha += taps->alpha * shared;
  const float2 alpha = taps->alpha.yz;
  sums->least_alpha = min(sums->least_alpha, select((float2)(FLT_MAX), alpha, taps->valid.yz));
  sums->most_alpha = max(sums->most_alpha, select((float2)(-FLT_MAX), alpha, taps->valid.yz));
#endif
}

// The cubic over the valid taps, held in the range of the middle four of those; bilinear where the cubic has lost most
// of its weights. In `confidence`, which is bilinear, what is not valid is not known.
static inline LayerTexel blend_of(const TapSums* sums, float2 fraction) {
  LayerTexel texel = {(float4)(0.0f), 0.0f, 1.0f, fraction, false};
  const float middle_weight = sum_of(sums->middle_weight), weight = sum_of(sums->weight);
  if (middle_weight < NO_TAPS) return texel;
  const float4 least = min(sums->least.lo, sums->least.hi), most = max(sums->most.lo, sums->most.hi);
  texel.value = weight < LEAST_TAPS ? add_four(sums->middle) / middle_weight
                                    : min(max(add_four(sums->value) / weight, least), most);
  texel.confidence = sum_of(sums->confidence);
#if ALPHA
  const float least_alpha = min(sums->least_alpha.x, sums->least_alpha.y);
  const float most_alpha = max(sums->most_alpha.x, sums->most_alpha.y);
  texel.alpha = weight < LEAST_TAPS ? sum_of(sums->middle_alpha) / middle_weight
                                    : min(max(sum_of(sums->alpha) / weight, least_alpha), most_alpha);
#endif
  return texel;
}

// The weights of four texels around a place that lies `fraction` behind the second.
static inline float4 cubic_row(float fraction, float sharpness) {
  const Cubic w = cubic_weights((float8)(fraction), sharpness);
  return (float4)(w.w0.s0, w.w1.s0, w.w2.s0, w.w3.s0);
}

static inline float4 linear_row(float fraction) {
  return (float4)(0.0f, 1.0f - fraction, fraction, 0.0f);
}

// At a place among the 4x4 texels from (x, y) on. A pixel of one layer among texels of one layer is none of ours: its
// history is what resolve_temporal fetches.
static inline LayerTexel resample_taps(const PastLayers* past, DEPTH_TEXELS depth, TexelLayout layout, LayerWish wish,
                                       int x, int y, float2 fraction) {
  const float4 wx = cubic_row(fraction.x, HISTORY_SHARPNESS), wy = cubic_row(fraction.y, HISTORY_SHARPNESS);
  const TapWindow window = window_at(past, x, y, 4);
  if (wish.kind == kOneLayer) {
    const Neighbourhood around = load_window(past->far, window);
    if (!has_split_texel(around)) {
      const float4 texel = sample_neighbourhood(around, wx, wy);
      const float confidence = clamp(texel.w, 0.0f, MOST_CONFIDENCE);
      LayerTexel alone = {(float4)(texel.xyz, 1.0f), confidence, 1.0f, fraction, false};
#if ALPHA
      alone.alpha = sample_alpha(past->alpha, x, y, wx, wy);
#endif
      return alone;
    }
  }
  const float4 linear_x = linear_row(fraction.x), linear_y = linear_row(fraction.y);
  TapSums sums = no_taps();
  LayerTaps taps = taps_of_row(past, depth, layout, wish, window, 0);
  add_taps(&sums, &taps, wx * wy.x, (float4)(0.0f), false);
  taps = taps_of_row(past, depth, layout, wish, window, 1);
  add_taps(&sums, &taps, wx * wy.y, linear_x * linear_y.y, true);
  taps = taps_of_row(past, depth, layout, wish, window, 2);
  add_taps(&sums, &taps, wx * wy.z, linear_x * linear_y.z, true);
  taps = taps_of_row(past, depth, layout, wish, window, 3);
  add_taps(&sums, &taps, wx * wy.w, (float4)(0.0f), false);
  return blend_of(&sums, fraction);
}

// The one texel (x, y).
static inline LayerTexel copy_tap(const PastLayers* past, DEPTH_TEXELS depth, TexelLayout layout, LayerWish wish,
                                  int x, int y) {
  LayerTexel texel = {(float4)(0.0f), 0.0f, 1.0f, (float2)(0.0f), false};
  const float4 far = load_history(past->far, y * past->far.width + x);
  if (wish.kind == kOneLayer && as_int(far.w) >= 0 && !wish.tests_depth) {
    texel.value = (float4)(far.xyz, 1.0f);
    texel.confidence = min(far.w, MOST_CONFIDENCE);
#if ALPHA
    texel.alpha = load_alpha(past->alpha, y * past->far.width + x);
#endif
    return texel;
  }
  const LayerTaps taps = taps_of_row(past, depth, layout, wish, window_at(past, x, y, 1), 0);
  if (taps.valid.s0 != 0) {
    texel.value = taps.value.s0123;
    texel.confidence = taps.confidence.s0;
    texel.alpha = taps.alpha.s0;
  }
  return texel;
}

// What history holds at `place`, an output position of the previous frame; `is_rigid`: of the layer that wishes.
static inline LayerTexel fetch_layer(const PastLayers* past, DEPTH_TEXELS depth, TexelLayout layout, LayerWish wish,
                                     float2 place, bool is_rigid) {
  const LayerTexel nothing = {(float4)(0.0f), 0.0f, 1.0f, (float2)(0.0f), false};
  const float2 size = (float2)((float)past->far.width, (float)past->far.height);
  const float2 at = clamp(place, -FARTHEST_SOURCE, FARTHEST_SOURCE);
  const float2 inside = clamp(floor(at), (float2)(0.0f), size - 1.0f);
  const int tile = layer_tile_at(past, (int)inside.x, (int)inside.y);
  const float2 far_phase = (float2)(past->tiles[tile].phase_x, past->tiles[tile].phase_y);
  const float2 near_phase = (float2)(past->layer_tiles[tile].phase_x, past->layer_tiles[tile].phase_y);
  // Which layer of the texel there it is, and so which phase it has.
  const float2 there = clamp(at - (wish.kind == kNearLayer ? near_phase : far_phase), (float2)(0.0f), size - 1.0f);
  const int there_x = (int)there.x, there_y = (int)there.y;
  const bool was_split = as_int(load_history(past->far, there_y * past->far.width + there_x).w) < 0;
  bool near = was_split && wish.kind == kNearLayer;
  if (was_split && wish.kind == kOneLayer)
    near = wish.near_depth > between_layers(state_at(past, depth, layout, there_x, there_y));
  wish.tests_depth = was_split;
  const float2 from = at - (near ? near_phase : far_phase) - 0.5f;  // 0 on the first texel
  if (any(from < -0.5f) || any(from > size - 0.5f)) return nothing;
  const float2 nearest = floor(from + 0.5f);
  LayerTexel texel;
  if (is_rigid && all(fabs(from - nearest) < LAYER_COPIED)) {
    const int x = clamp((int)nearest.x, 0, past->far.width - 1), y = clamp((int)nearest.y, 0, past->far.height - 1);
    texel = copy_tap(past, depth, layout, wish, x, y);
  } else {
    const float2 base = floor(from);
    texel = resample_taps(past, depth, layout, wish, (int)base.x - 1, (int)base.y - 1, from - base);
  }
  texel.was_split = was_split;
  return texel;
}
