// SPDX-License-Identifier: MIT
// Rectification: history that is rejected is brought into the range of this frame's samples around the pixel, in tone
// space, c / (1 + max c), where differences are perceptual. After Karis, "High-Quality Temporal Supersampling", 2014,
// but only where there is evidence against history: applied everywhere, as is usual, it loses .5 dB, on still pictures
// 6 (docs/lab/temporal.md).
#pragma once

#include "temporal/constants.h"
#include "temporal/frame_samples.h"

// A colour in each lane, in tone space.
typedef struct Tone {
  LaneFloat red, green, blue;
} Tone;

static inline LaneFloat largest_channel(Tone colour) {
  return max(max(max(colour.red, colour.green), colour.blue), 0.0f);
}

static inline Tone to_tone(LaneTexels texels) {
  const Tone light = {reds(texels), greens(texels), blues(texels)};
  const LaneFloat divisor = 1.0f + largest_channel(light);
  const Tone tone = {light.red / divisor, light.green / divisor, light.blue / divisor};
  return tone;
}

// One channel of the valid ones of a cross of samples: the first, and sums of the differences from it, which are small,
// so that their squares lose no digits.
typedef struct CrossChannel {
  LaneFloat first, sum, squares;
} CrossChannel;

static inline void add_channel(CrossChannel* cross, LaneFloat tone, LaneMask valid, LaneMask is_first) {
  const LaneFloat none = (LaneFloat)(0.0f);
  cross->first = select(cross->first, tone, is_first);
  const LaneFloat difference = select(none, tone - cross->first, valid);
  cross->sum += difference;
  cross->squares += difference * difference;
}

// The range that a pixel's surroundings allow in one channel: its middle, and how far from there.
typedef struct ToneRange {
  LaneFloat mean, deviation;
} ToneRange;

static inline ToneRange range_of_cross(const CrossChannel* cross, LaneFloat count) {
  const LaneFloat mean = cross->sum / count;
  const LaneFloat variance = cross->squares / count - mean * mean;
  const ToneRange range = {cross->first + mean, BOX_SIZE * sqrt(max(variance, 0.0f))};
  return range;
}

// The ranges of the samples nearest to the pixels and the four beside each. Without a valid sample nothing is known.
typedef struct ToneBoxes {
  ToneRange red, green, blue;
  LaneMask known;
} ToneBoxes;

static inline ToneBoxes boxes_around(COLOUR_TEXELS texels, const ExposedFrame* frame, LaneInt x, int y) {
  const int last_x = frame->width - 1, last_y = frame->height - 1;
  const LaneFloat none = (LaneFloat)(0.0f), one = (LaneFloat)(1.0f);
  const CrossChannel empty = {none, none, none};
  CrossChannel red = empty, green = empty, blue = empty;
  LaneFloat count = none;
  UNROLL_ALWAYS(5)
  for (int i = 0; i < 5; ++i) {
    const int column = (i == 1) - (i == 2), row = (i == 3) - (i == 4);
    const LaneInt columns = clamp(x + column, (LaneInt)(0), (LaneInt)(last_x));
    const LaneTexels samples = held_samples(load_samples(texels, frame, columns, clamp(y + row, 0, last_y)));
    const LaneMask valid = are_valid(samples), is_first = valid & (count == none);
    const Tone tone = to_tone(samples);
    add_channel(&red, tone.red, valid, is_first);
    add_channel(&green, tone.green, valid, is_first);
    add_channel(&blue, tone.blue, valid, is_first);
    count += select(none, one, valid);
  }
  const LaneFloat divisor = max(count, 1.0f);
  const ToneBoxes boxes = {range_of_cross(&red, divisor), range_of_cross(&green, divisor),
                           range_of_cross(&blue, divisor), count > none};
  return boxes;
}

static inline LaneFloat step_into(ToneRange range, LaneFloat tone) {
  return clamp(tone, range.mean - range.deviation, range.mean + range.deviation) - tone;
}

// History moved to its boxes by `rejection` of the way, and the part of its confidence that is left: it falls by how
// far it lay outside.
typedef struct Rectified {
  LaneTexels history;
  LaneFloat part;
} Rectified;

static inline Rectified rectify_texels(LaneTexels history, LaneFloat rejection, const ToneBoxes* boxes) {
  const Tone tone = to_tone(history);
  const Tone step = {step_into(boxes->red, tone.red), step_into(boxes->green, tone.green),
                     step_into(boxes->blue, tone.blue)};
  const LaneFloat distance = fabs(step.red) + fabs(step.green) + fabs(step.blue);
  const LaneFloat spread = boxes->red.deviation + boxes->green.deviation + boxes->blue.deviation;
  const LaneFloat part = 1.0f - rejection * min(1.0f, distance / (spread + BOX_MARGIN));
  const Tone moved = {tone.red + step.red * rejection, tone.green + step.green * rejection,
                      tone.blue + step.blue * rejection};
  const LaneFloat rest = max(1.0f - largest_channel(moved), TONE_REST_MIN);
  const LaneMask is_rejected = boxes->known & (rejection > 0.0f), is_moved = is_rejected & (distance > 0.0f);
  const Rectified rectified = {texels_of(select(reds(history), moved.red / rest, is_moved),
                                         select(greens(history), moved.green / rest, is_moved),
                                         select(blues(history), moved.blue / rest, is_moved), last_channels(history)),
                               select((LaneFloat)(1.0f), part, is_rejected)};
  return rectified;
}

// Moves alpha by `rejection` of the way into the range of the valid ones of sample (x, y) and its four neighbours.
static inline float rectify_alpha(COLOUR_TEXELS texels, const ExposedFrame* frame, int x, int y, float alpha,
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

// Rectifies the alphas of the pixels.
static inline LaneFloat rectify_alphas(COLOUR_TEXELS texels, const ExposedFrame* frame, LaneInt x, int y,
                                       LaneFloat alphas, LaneFloat rejection) {
  for (int i = 0; i < kLanes; ++i) {
    const float own = FIRST_LANE(rejection);
    if (own > 0.0f) FIRST_LANE(alphas) = rectify_alpha(texels, frame, FIRST_LANE(x), y, FIRST_LANE(alphas), own);
    alphas = NEXT_LANES(alphas);
    rejection = NEXT_LANES(rejection);
    x = NEXT_LANES(x);
  }
  return alphas;
}

// ---- Alpha that fades, or moves unlike the surfaces. No gain tells of it, as it is no light.

// The range of alphas. Without any, least > most.
typedef struct AlphaRange {
  float least, most;
} AlphaRange;

static inline AlphaRange no_alphas(void) {
  const AlphaRange range = {FLT_MAX, -FLT_MAX};
  return range;
}

static inline void add_to_range(AlphaRange* range, float alpha) {
  range->least = min(range->least, alpha);
  range->most = max(range->most, alpha);
}

// Returns history's alpha moved into the range of this frame's, but for what it varies by around: samples may have
// missed that. Those of cut-outs, which are 0 or 1, move only history that is even.
static inline float follow_alpha(float alpha, AlphaRange range, float uneven) {
  const bool is_soft = range.least > 0.0f && range.most < 1.0f;
  if (!is_soft && uneven > EVEN_ALPHA_MAX) return alpha;
  const float step = clamp(alpha, range.least, range.most) - alpha;
  return alpha + copysign(max(fabs(step) - uneven, 0.0f), step);
}

// Returns by how much alpha varies over those of the 3x3 texels around (x, y) that have as many layers; clamped to the
// edge.
static inline float uneven_alpha(HistoryLayer layer, AlphaPlane plane, int x, int y) {
  const int own = clamp(y, 0, plane.height - 1) * plane.width + clamp(x, 0, plane.width - 1);
  const bool has_two = confidence_sign(layer, own) < 0;
  AlphaRange range = no_alphas();
  for (int i = 0; i < 9; ++i) {
    const int column = clamp(x + i % 3 - 1, 0, plane.width - 1), row = clamp(y + i / 3 - 1, 0, plane.height - 1);
    const int index = row * plane.width + column;
    if ((confidence_sign(layer, index) < 0) == has_two) add_to_range(&range, load_alpha(plane, index));
  }
  return range.most - range.least;
}

// Moves the alphas of pixels of one layer, in `lanes`, into the range of those of the 3x3 samples around the nearest
// ones. `from`: the texels nearest to the places of their history.
static inline LaneFloat follow_alphas(COLOUR_TEXELS texels, const ExposedFrame* frame, HistoryLayer layer,
                                      AlphaPlane plane, LaneInt from_x, LaneInt from_y, LaneInt x, int y,
                                      LaneFloat alphas, LaneMask lanes) {
  for (int i = 0; i < kLanes; ++i) {
    if (FIRST_LANE(lanes)) {
      AlphaRange range = no_alphas();
      for (int j = 0; j < 9; ++j) {
        const float4 sample = sample_at(texels, frame, FIRST_LANE(x) + j % 3 - 1, y + j / 3 - 1);
        if (is_valid(sample)) add_to_range(&range, sample.w);
      }
      const float own = FIRST_LANE(alphas);
      if (range.least <= range.most && (own < range.least || own > range.most))
        FIRST_LANE(alphas) =
            follow_alpha(own, range, uneven_alpha(layer, plane, FIRST_LANE(from_x), FIRST_LANE(from_y)));
    }
    alphas = NEXT_LANES(alphas);
    lanes = NEXT_LANES(lanes);
    from_x = NEXT_LANES(from_x);
    from_y = NEXT_LANES(from_y);
    x = NEXT_LANES(x);
  }
  return alphas;
}
