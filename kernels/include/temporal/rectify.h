// SPDX-License-Identifier: MIT
// Rectification: history that is rejected is brought into the range of this frame's samples around the pixel, in tone
// space, c / (1 + max c), where differences are perceptual. After Karis, "High-Quality Temporal Supersampling", 2014,
// but only where there is evidence against history: applied everywhere, as is usual, it loses .5 dB, on still pictures
// 6 (docs/lab/temporal.md).
#pragma once

#include "temporal/constants.h"
#include "temporal/frame_samples.h"

// Returns in each channel of four texels the largest of that texel's channels, its last one included.
static inline float16 largest_channels(float16 texels) {
  const float16 pairs = max(texels, texels.s1032547698badcfe);
  return max(pairs, pairs.s23016745ab89efcd);
}

// Returns in each channel of four texels the sum of that texel's channels.
static inline float16 channel_sums(float16 texels) {
  const float16 pairs = texels + texels.s1032547698badcfe;
  return pairs + pairs.s23016745ab89efcd;
}

static inline float16 without_alpha(float16 texels) {
  return select(texels, (float16)(0.0f), LAST_CHANNELS);
}

static inline float16 to_tone(float16 colours) {
  const float16 light = without_alpha(colours);
  return light / (1.0f + largest_channels(light));
}

static inline float16 from_tone(float16 tone) {
  return tone / max(1.0f - largest_channels(without_alpha(tone)), TONE_REST_MIN);
}

// Sums over the valid ones of a cross of samples around four pixels, in tone space.
typedef struct CrossSums {
  float16 first, sum, squares, count;
} CrossSums;

static inline CrossSums add_to_cross(CrossSums cross, float16 samples) {
  const int16 valid = are_valid(samples);
  const float16 tone = to_tone(samples), none = (float16)(0.0f);
  cross.first = select(cross.first, tone, valid & (cross.count == none));
  const float16 difference = select(none, tone - cross.first, valid);  // small, so that its square loses no digits
  cross.sum += difference;
  cross.squares += difference * difference;
  cross.count += select(none, (float16)(1.0f), valid);
  return cross;
}

typedef struct EightCrosses {
  CrossSums left, right;
} EightCrosses;

static inline EightCrosses add_to_crosses(EightCrosses crosses, EightTexels samples) {
  const EightCrosses sums = {add_to_cross(crosses.left, samples.left), add_to_cross(crosses.right, samples.right)};
  return sums;
}

// The ranges that the surroundings of four pixels allow, in tone space: the mean of red, green and blue, and how far
// from it. Without a valid sample nothing is known.
typedef struct ToneBoxes {
  float16 mean, deviation;
  int16 known;
} ToneBoxes;

static inline ToneBoxes boxes_of(CrossSums cross) {
  const float16 count = max(cross.count, 1.0f);
  const float16 mean = cross.sum / count;
  const float16 variance = cross.squares / count - mean * mean;
  const ToneBoxes boxes = {cross.first + mean, BOX_SIZE * sqrt(max(variance, 0.0f)), cross.count > 0.0f};
  return boxes;
}

// The ranges of the samples nearest to eight pixels and the four beside each.
typedef struct EightBoxes {
  ToneBoxes left, right;
} EightBoxes;

static inline EightBoxes boxes_around(COLOUR_TEXELS texels, const SourceFrame* frame, int8 x, int y) {
  const TexelLayout layout = frame->colour;
  const int last_x = frame->width - 1, last_y = frame->height - 1;
  const float16 none = (float16)(0.0f);
  const CrossSums empty = {none, none, none, none};
  EightCrosses crosses = {empty, empty};
  UNROLL_ALWAYS(5)
  for (int i = 0; i < 5; ++i) {
    const int column = (i == 1) - (i == 2), row = (i == 3) - (i == 4);
    const int8 columns = clamp(x + column, (int8)(0), (int8)(last_x));
    crosses = add_to_crosses(crosses, load_samples(texels, layout, columns, clamp(y + row, 0, last_y)));
  }
  const EightBoxes boxes = {boxes_of(crosses.left), boxes_of(crosses.right)};
  return boxes;
}

// Four texels of history moved to their boxes by `rejection` of the way, and the parts of their confidence that are
// left: it falls by how far they lay outside.
typedef struct Rectified {
  float16 history;
  float4 part;
} Rectified;

static inline Rectified rectify4(float16 history, float4 rejection, const ToneBoxes* boxes) {
  const float16 share = to_four_texels(rejection);
  const float16 tone = to_tone(history);
  const float16 step = clamp(tone, boxes->mean - boxes->deviation, boxes->mean + boxes->deviation) - tone;
  const float16 distance = channel_sums(fabs(step)), spread = channel_sums(boxes->deviation);
  const float16 part = 1.0f - share * min(1.0f, distance / (spread + BOX_MARGIN));
  const int16 moved = boxes->known & (share > 0.0f);
  const Rectified rectified = {select(history, from_tone(tone + step * share), moved & (distance > 0.0f)),
                               select((float16)(1.0f), part, moved).s048c};
  return rectified;
}

// Moves alpha by `rejection` of the way into the range of the valid ones of sample (x, y) and its four neighbours.
static inline float rectify_alpha(COLOUR_TEXELS texels, const SourceFrame* frame, int x, int y, float alpha,
                                  float rejection) {
  float first = 0.0f, sum = 0.0f, squares = 0.0f, count = 0.0f;
  for (int i = 0; i < 5; ++i) {
    const int column = (i == 1) - (i == 2), row = (i == 3) - (i == 4);
    const float4 sample = sample_at(texels, frame, x + column, y + row);
    if (!is_valid(sample)) continue;
    if (count == 0.0f) first = sample.w;
    const float difference = sample.w - first;
    sum += difference;
    squares += difference * difference;
    count += 1.0f;
  }
  if (count == 0.0f) return alpha;
  const float mean = sum / count;
  const float deviation = BOX_SIZE * sqrt(max(squares / count - mean * mean, 0.0f));
  const float middle = first + mean;
  return alpha + (clamp(alpha, middle - deviation, middle + deviation) - alpha) * rejection;
}

// Rectifies the alphas of eight pixels.
static inline float8 rectify_alphas(COLOUR_TEXELS texels, const SourceFrame* frame, int8 x, int y, float8 alphas,
                                    float8 rejection) {
  for (int i = 0; i < kLanes; ++i) {
    if (rejection.s0 > 0.0f) alphas.s0 = rectify_alpha(texels, frame, x.s0, y, alphas.s0, rejection.s0);
    alphas = NEXT_LANES(alphas);
    rejection = NEXT_LANES(rejection);
    x = NEXT_LANES(x);
  }
  return alphas;
}
