// SPDX-License-Identifier: MIT
// For resolve_checkerboard: the colour of a pixel that is not shaded.
#pragma once

#include "checkerboard/checkerboard_params.h"
#include "stored_frame.h"
#include "checkerboard/surfaces.h"

#define LEAST_DIFFERENCE 1e-12f    // squared: two pairs that are equal count alike

// Where one of the surfaces was that a pixel may show, and the trust in that.
typedef struct PastPixel {
  float x, y, trust;
} PastPixel;

// A neighbour's colour; weight 0 where there is none.
typedef struct ShadedSample {
  float4 colour;
  float weight;
} ShadedSample;

static inline ShadedSample shaded_sample(const CheckerboardParams* params, COLOUR_TEXELS texels, int x, int y) {
  ShadedSample sample = {(float4)(0.0f), 0.0f};
  if (x < 0 || y < 0 || x >= params->width || y >= params->height) return sample;
  const float4 colour = load_colour(texels, params->shaded.colour, x, y);
  if (any_non_finite4(colour)) return sample;
  sample.colour = colour;
  sample.weight = 1.0f;
  return sample;
}

// The neighbours on both sides of a pixel on one axis.
typedef struct SamplePair {
  float4 mean;
  float difference;  // squared
  int count;
} SamplePair;

static inline SamplePair pair_of(ShadedSample a, ShadedSample b) {
  SamplePair pair;
  const float4 apart = clamp(a.colour - b.colour, -INFINITY_STAND_IN, INFINITY_STAND_IN);
  pair.count = (a.weight > 0.0f) + (b.weight > 0.0f);
  pair.mean = (a.colour + b.colour) * (pair.count == 2 ? 0.5f : 1.0f);
  pair.difference = dot(apart, apart);
  return pair;
}

// The mean of both pairs, that of the more alike one counting more: by the squared difference of the other.
static inline float4 mean_along_edge(SamplePair across, SamplePair down) {
  if (across.count == 0) return down.mean;
  if (down.count == 0) return across.mean;
  const bool both = across.count == 2 && down.count == 2;
  const float by_across = down.difference + LEAST_DIFFERENCE, by_down = across.difference + LEAST_DIFFERENCE;
  const float part = both ? by_across / (by_across + by_down) : 0.5f;
  return across.mean * part + down.mean * (1.0f - part);
}

// The range of the neighbours.
typedef struct ColourRange {
  float4 low, high;
} ColourRange;

static inline ColourRange widened(ColourRange range, ShadedSample sample) {
  if (sample.weight == 0.0f) return range;
  const ColourRange wider = {min(range.low, sample.colour), max(range.high, sample.colour)};
  return wider;
}

// On one axis, as FourBetween.
typedef struct Between {
  int low, high;
  float fraction;
} Between;

static inline Between between_two(float at, int size) {
  const float whole = floor(at);
  Between between;
  between.fraction = at - whole;
  between.low = clamp((int)whole, 0, size - 1);
  between.high = clamp((int)whole + (between.fraction > 0.0f), 0, size - 1);
  return between;
}

// The previous colour at a place, within the range; its trust is 0 where it is not finite.
typedef struct PastColour {
  float4 colour;
  float trust;
} PastColour;

static inline PastColour past_colour(const CheckerboardParams* params, COLOUR_TEXELS previous, PastPixel past,
                                     ColourRange range) {
  PastColour found = {(float4)(0.0f), 0.0f};
  if (past.trust <= 0.0f) return found;
  const Between column = between_two(past.x, params->previous_width);
  const Between row = between_two(past.y, params->previous_height);
  const float4 upper_left = load_colour(previous, params->previous_colour, column.low, row.low);
  const float4 upper_right = load_colour(previous, params->previous_colour, column.high, row.low);
  const float4 lower_left = load_colour(previous, params->previous_colour, column.low, row.high);
  const float4 lower_right = load_colour(previous, params->previous_colour, column.high, row.high);
  const int4 largest = larger_magnitude(larger_magnitude((int4)(0), upper_left), upper_right);
  if (any_reached_infinity(larger_magnitude(larger_magnitude(largest, lower_left), lower_right))) return found;
  const float4 upper = upper_left + (upper_right - upper_left) * column.fraction;
  const float4 lower = lower_left + (lower_right - lower_left) * column.fraction;
  found.colour = clamp(upper + (lower - upper) * row.fraction, range.low, range.high);
  found.trust = past.trust;
  return found;
}

static inline float4 over_rest(PastColour past, float4 rest) {
  return past.colour * past.trust + rest * (1.0f - past.trust);
}

static inline float4 filled_colour(const CheckerboardParams* params, COLOUR_TEXELS shaded, COLOUR_TEXELS previous,
                                   int x, int y, PastPixel near, PastPixel far) {
  const ShadedSample left = shaded_sample(params, shaded, x - 1, y), right = shaded_sample(params, shaded, x + 1, y);
  const ShadedSample above = shaded_sample(params, shaded, x, y - 1), below = shaded_sample(params, shaded, x, y + 1);
  ColourRange range = {(float4)(INFINITY), (float4)(-INFINITY)};
  range = widened(widened(widened(widened(range, left), right), above), below);
  if (left.weight + right.weight + above.weight + below.weight == 0.0f) range.low = range.high = (float4)(0.0f);
  const PastColour nearest = past_colour(params, previous, near, range);
  if (nearest.trust >= 1.0f) return nearest.colour;
  float4 rest = mean_along_edge(pair_of(left, right), pair_of(above, below));
  if (near.trust < 1.0f) rest = over_rest(past_colour(params, previous, far, range), rest);
  return over_rest(nearest, rest);
}
