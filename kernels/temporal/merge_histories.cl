// SPDX-License-Identifier: MIT
// merge_histories: makes one history of two, of the frames up to this one and of those from this one on, both at the
// pixels' centres, in exposed light. With a of confidence W, b of V, and t(c) = c / (1 + max(red, green, blue, 0)):
//   t(m) = l t(a) + (1 - l) t(b),  l = f(W) / (f(W) + f(V)),  f(W) = W^2 / (W + 1) + .001
//   Its confidence is W + V, negative (two layers) where one of them is. Alpha is merged without t.
//   Of two layers, W is a mean by shares: 1 / (W + .1) = (1 - c) / (F + .1) + c / (N + .1), with F of the far layer, N
//   of the near one and its coverage c: where little is known of the near layer, its coverage may be wrong.
//
//   params        in   extent, layout
//   centred       in   RGBA32F or RGBA16F, output extent: the picture of history, layers laid together, not smoothed
//   history       in   of its texels the confidence alone
//   near_history  in   of texels of two layers the coverage
//   states        in   LayerState of texels of two layers
//   other         in   the other history, as merged, in light exposed by params.other_exposure, if there is one
//   other_alpha   in   ALPHA 1: its alpha
//   merged        out  history
//   merged_alpha  out  ALPHA 1: its alpha
//   exposure      in   Exposure of this frame
// Options: ALPHA          1 (default) | 0: all is opaque
//          SOURCE_FORMAT  HALF (default) | FLOAT   of centred
//          HISTORY_FORMAT as in temporal/history.h
// Source: measured (docs/lab/sequences.md).   Reference: tests/reference/merge_histories.cpp
#include "layers/past_layers.h"
#include "picture_params.h"
#include "temporal/constants.h"
#include "temporal/history.h"
#include "temporal/temporal_params.h"
#include "texel.h"

#ifndef ALPHA
#define ALPHA 1
#endif
#if ALPHA < 0 || ALPHA > 1
#error "ALPHA must be 0 or 1"
#endif

#define MERGE_WEIGHT_MIN 1e-3f        // of what nothing is known of: seeds still count, all alike
#define MERGE_LAYER_CONFIDENCE 0.1f  // added to that of each of two layers; .02 and .2: within .002 dB

static inline float merge_weight(float confidence) {
  return confidence * confidence / (confidence + 1.0f) + MERGE_WEIGHT_MIN;
}

// The confidence of a texel's layers together; negative where there are two.
static inline float confidence_at(HistoryLayer far, HistoryLayer near, __global const half* states, int index) {
  const float own = load_confidence(far, index);
  if (as_int(own) >= 0) return own;
  const float known = fabs(own) + MERGE_LAYER_CONFIDENCE;
  const float near_known = load_state(states, index).near_confidence + MERGE_LAYER_CONFIDENCE;
  const float coverage = clamp(load_history(near, index).w, 0.0f, 1.0f);
  const float together = known * near_known / (near_known + coverage * (known - near_known));
  return -max(together - MERGE_LAYER_CONFIDENCE, 0.0f);
}

static inline float brightest_of(float4 colour) {
  return max(max(max(colour.x, colour.y), colour.z), 0.0f);
}

// Alpha stays as it is.
static inline float4 tone_of(float4 colour) {
  return (float4)(colour.xyz / (1.0f + brightest_of(colour)), colour.w);
}

static inline float4 untone(float4 tone) {
  return (float4)(tone.xyz / max(1.0f - brightest_of(tone), TONE_REST_MIN), tone.w);
}

__kernel void merge_histories(const MergeParams params, RESOLVED_TEXELS centred, HISTORY_TEXELS history,
                              HISTORY_TEXELS near_history, __global const half* states, HISTORY_TEXELS other,
                              HISTORY_TEXELS other_alpha, STORED_HISTORY merged, STORED_HISTORY merged_alpha,
                              __global const Exposure* exposure) {
  const int y = get_global_id(1);
  const int first = get_global_id(0) * params.columns_per_item;
  if (first >= params.width || y >= params.height) return;

  const HistoryLayer own = {history, params.width, params.height}, others = {other, params.width, params.height};
  const HistoryLayer near = {near_history, params.width, params.height};
  const int end = min(first + params.columns_per_item, params.width);
  const bool has_other = params.other_exposure != 0.0f;
  const float change = has_other ? exposure->factor / params.other_exposure : 1.0f;
  for (int x = first; x < end; ++x) {
    const int index = y * params.width + x;
    float4 made = load_resolved(centred, params.centred, x, y);
    made.xyz *= exposure->factor;
    float confidence = confidence_at(own, near, states, index);
    if (has_other) {
      const float4 texel = load_history(others, index);
      float4 second = (float4)(texel.xyz * change, 1.0f);
#if ALPHA
      const AlphaPlane plane = {other_alpha, params.width, params.height};
      second.w = load_alpha(plane, index);
#endif
      const float weight = merge_weight(fabs(confidence)), second_weight = merge_weight(fabs(texel.w));
      const float4 tone = tone_of(made), second_tone = tone_of(second);
      made = untone(tone + (second_tone - tone) * (second_weight / (weight + second_weight)));
      const bool has_layers = (as_int(confidence) | as_int(texel.w)) < 0;
      const float sum = fabs(confidence) + fabs(texel.w);
      confidence = has_layers ? -sum : sum;
    }
    store_history(merged, index, (float4)(made.xyz, confidence));
#if ALPHA
    const float alpha = clamp(made.w, -FINITE_HALF_MAX, FINITE_HALF_MAX);
#if HISTORY_FORMAT == HALF
    vstore_half_rte(alpha, index, merged_alpha);
#else
    merged_alpha[index] = alpha;
#endif
#endif
  }
}
