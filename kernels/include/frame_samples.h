// SPDX-License-Identifier: MIT
// The samples of this frame around a place, one after another. Those that are not finite, or as large as a half can be, take no
// part.
#pragma once

#include "texel.h"

#define INVALID_BITS 0x477fe000  // of 65504, the largest half
#define DARKEST_REST 0x1p-16f
#define BOX_SIZE 0.75f       // standard deviations
#define BOX_MARGIN 0.02f

static inline bool is_valid(float4 sample) {
  const long2 hits = as_long2((as_int4(sample) & 0x7fffffff) >= INVALID_BITS);
  return (hits.x | hits.y) == 0;
}

static inline float largest_colour(float4 colour) {
  return max(max(colour.x, colour.y), max(colour.z, 0.0f));
}

// Beyond the viewport's edges the outermost sample once more.
static inline float4 sample_at(COLOUR_TEXELS texels, const SourceFrame* frame, int x, int y) {
  return load_colour(texels, frame->colour, clamp(x, 0, frame->width - 1), clamp(y, 0, frame->height - 1));
}

// What a valid sample counts: the less the brighter it is, so that one does not outshine the others.
static inline float worth_of(float4 sample) {
  return 1.0f / max(1.0f, 0.5f * largest_colour(sample));
}

// c / (1 + max c): differences as the eye has them rather than as light.
static inline float4 to_tone(float4 colour) {
  return (float4)((colour / (1.0f + largest_colour(colour))).xyz, 0.0f);
}

static inline float4 from_tone(float4 tone) {
  return tone / max(1.0f - largest_colour(tone), DARKEST_REST);
}

// What a pixel's surroundings allow, in tone space: mean and deviation of red, green and blue.
typedef struct ToneBox {
  float4 mean, deviation;
  bool any;  // false: no sample is valid, and nothing is known
} ToneBox;

// Of the sample (x, y) and its four neighbours.
static inline ToneBox tone_box(COLOUR_TEXELS texels, const SourceFrame* frame, int x, int y) {
  float4 first = (float4)(0.0f), sum = (float4)(0.0f), squares = (float4)(0.0f);
  float count = 0.0f;
  for (int i = 0; i < 5; ++i) {
    const int column = (i == 1) - (i == 2), row = (i == 3) - (i == 4);
    const float4 sample = sample_at(texels, frame, x + column, y + row);
    if (!is_valid(sample)) continue;
    const float4 tone = to_tone(sample);
    if (count == 0.0f) first = tone;
    const float4 difference = tone - first;  // of these squares no digits are lost
    sum += difference;
    squares += difference * difference;
    count += 1.0f;
  }
  const float4 mean = sum / max(count, 1.0f);
  const float4 variance = squares / max(count, 1.0f) - mean * mean;
  const ToneBox box = {first + mean, BOX_SIZE * sqrt(max(variance, (float4)(0.0f))), count > 0.0f};
  return box;
}

// Moves history towards what the surroundings allow, by `strength` of the way; its confidence, in w, falls by what it was wrong.
static inline float4 rectify(float4 history, float confidence, float strength, const ToneBox* box) {
  if (!box->any) return (float4)(history.xyz, confidence);
  const float4 tone = to_tone(history);
  const float4 step = clamp(tone, box->mean - box->deviation, box->mean + box->deviation) - tone;
  const float distance = fabs(step.x) + fabs(step.y) + fabs(step.z);
  const float spread = box->deviation.x + box->deviation.y + box->deviation.z;
  float4 result = history;
  if (distance > 0.0f) result = from_tone(tone + step * strength);
  result.w = confidence * (1.0f - strength * min(1.0f, distance / (spread + BOX_MARGIN)));
  return result;
}
