// SPDX-License-Identifier: MIT
// Rectification: history that is rejected is brought into the range of this frame's samples around the pixel, in tone
// space, c / (1 + max c), where differences are as the eye has them rather than as light. After Karis, "High-Quality
// Temporal Supersampling", 2014, but only where something speaks against history: applied everywhere, as is usual, it
// costs .5 dB, on still pictures 6 (docs/temporal.md).
#pragma once

#include "temporal/frame_samples.h"

#define DARKEST_REST 0x1p-16f  // of 1 - max tone: where rounding would make the way back infinite
// Found by search on the development scenes.
#define BOX_SIZE 0.75f    // standard deviations on each side of the mean
#define BOX_MARGIN 0.02f  // tone: a distance from the box that takes all confidence where the samples are all alike

static inline float4 to_tone(float4 colour) {
  return (float4)((colour / (1.0f + largest_colour(colour))).xyz, 0.0f);
}

static inline float4 from_tone(float4 tone) {
  return tone / max(1.0f - largest_colour(tone), DARKEST_REST);
}

// The range that a pixel's surroundings allow, in tone space: the mean of red, green and blue, and how far from it.
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

// Moves history to the box by `rejection` of the way. Its confidence, in w, falls by how far it lay outside.
static inline float4 rectify(float4 history, float confidence, float rejection, const ToneBox* box) {
  if (!box->any) return (float4)(history.xyz, confidence);
  const float4 tone = to_tone(history);
  const float4 step = clamp(tone, box->mean - box->deviation, box->mean + box->deviation) - tone;
  const float distance = fabs(step.x) + fabs(step.y) + fabs(step.z);
  const float spread = box->deviation.x + box->deviation.y + box->deviation.z;
  float4 result = history;
  if (distance > 0.0f) result = from_tone(tone + step * rejection);
  result.w = confidence * (1.0f - rejection * min(1.0f, distance / (spread + BOX_MARGIN)));
  return result;
}
