// SPDX-License-Identifier: MIT
// Fetching history of one pixel where texels may have two layers.
#pragma once

#include "layers/layer_taps.h"

#define LAYER_COPIED 0.06f  // texels: a place of a rigid layer this near to a texel is that texel
#define LEAST_TAPS 0.5f     // of the weights of all taps: less is no cubic any more
#define NO_TAPS 1e-3f       // of the weights of the middle four: less is nothing

static inline Neighbourhood load_window(HistoryLayer layer, TapWindow window) {
  return window.is_inside ? load_neighbourhood(layer, window.x, window.y)
                          : load_neighbourhood_clamped(layer, window.x, window.y);
}

static inline bool has_split_texel(Neighbourhood around) {
  const int16 signs = as_int16(around.row0) | as_int16(around.row1) | as_int16(around.row2) | as_int16(around.row3);
  return any(signs.s37bf < 0);
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
