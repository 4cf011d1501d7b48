// SPDX-License-Identifier: MIT
// merge_histories: makes one history of two, of the frames up to this one and of those from this one on, both at the
// pixels' centres. With a of confidence W, b of confidence V and t(c) = c / (1 + max(red, green, blue, 0)):
//   t(m) = l t(a) + (1 - l) t(b),  l = f(W) / (f(W) + f(V)),  f(W) = W^2 / (W + 1) + .001
//   Its confidence is W + V, negative (two layers) where one of them is. There f(W) = (W / (W + 1))^2 + .001: W tells
//   nothing of the near layer's coverage, where both may err. Alpha is merged without t.
//
//   params        in   extent, layout
//   centred       in   RGBA32F or RGBA16F, output extent: the picture of history, layers laid together, not smoothed
//   history       in   of its texels the confidence alone
//   other         in   the other history, as merged; read only where there is one
//   other_alpha   in   ALPHA 1: its alpha
//   merged        out  history
//   merged_alpha  out  ALPHA 1: its alpha
// Options: ALPHA          1 (default) | 0: all is opaque
//          SOURCE_FORMAT  HALF (default) | FLOAT   of centred
//          HISTORY_FORMAT as in temporal/history.h
// Source: measured (docs/lab/sequences.md).   Reference: tests/reference/merge_histories.cpp
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

#define MERGE_WEIGHT_MIN 1e-3f  // of what nothing is known of: seeds still count, all alike

static inline float merge_weight(float confidence, bool has_layers) {
  const float part = confidence / (confidence + 1.0f);
  return part * (has_layers ? part : confidence) + MERGE_WEIGHT_MIN;
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
                              HISTORY_TEXELS other, HISTORY_TEXELS other_alpha, STORED_HISTORY merged,
                              STORED_HISTORY merged_alpha) {
  const int y = get_global_id(1);
  const int first = get_global_id(0) * params.columns_per_item;
  if (first >= params.width || y >= params.height) return;

  const HistoryLayer own = {history, params.width, params.height}, others = {other, params.width, params.height};
  const int end = min(first + params.columns_per_item, params.width);
  for (int x = first; x < end; ++x) {
    const int index = y * params.width + x;
    float4 made = load_resolved(centred, params.centred, x, y);
    float confidence = load_confidence(own, index);
    if (params.has_other) {
      const float4 texel = load_history(others, index);
      float4 second = (float4)(texel.xyz, 1.0f);
#if ALPHA
      const AlphaPlane plane = {other_alpha, params.width, params.height};
      second.w = load_alpha(plane, index);
#endif
      const bool has_layers = (as_int(confidence) | as_int(texel.w)) < 0;
      const float weight = merge_weight(fabs(confidence), has_layers);
      const float second_weight = merge_weight(fabs(texel.w), has_layers);
      const float4 tone = tone_of(made), second_tone = tone_of(second);
      made = untone(tone + (second_tone - tone) * (second_weight / (weight + second_weight)));
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
