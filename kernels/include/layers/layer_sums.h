// SPDX-License-Identifier: MIT
// Sums over the 4x4 texels of history around the places of eight pixels, and the layers that they give.
#pragma once

#include "layers/layer_taps.h"

#define LEAST_TAPS 0.5f  // of the weights of all taps: less is no cubic any more
#define NO_TAPS 1e-3f    // of the weights of the middle four: less is nothing

// Premultiplied colours and coverages of eight pixels, by channel.
typedef struct LayerColours {
  float8 red, green, blue, coverage;
  float8 alpha;  // with ALPHA
} LayerColours;

typedef struct LayerSums {
  LayerColours cubic, bilinear;        // over the valid taps
  LayerColours least, most;            // of the valid ones of the middle four
  float8 weight, middle_weight;        // of the valid taps
  float8 confidence;                   // bilinear; what is not valid is not known
  // Of all taps as they are stored, for pixels without a texel of two layers.
  float8 stored, least_stored, most_stored;
  int8 has_two;                        // a tap has two layers
} LayerSums;

static inline LayerColours all_colours(float value) {
  const float8 all = (float8)(value);
  const LayerColours colours = {all, all, all, all, all};
  return colours;
}

static inline LayerSums no_taps(void) {
  const float8 none = (float8)(0.0f);
  const LayerSums sums = {all_colours(0.0f), all_colours(0.0f), all_colours(FLT_MAX), all_colours(-FLT_MAX),
                          none, none, none, none, (float8)(FLT_MAX), (float8)(-FLT_MAX), (int8)(0)};
  return sums;
}

static inline void add_colours(LayerColours* sum, const LayerTaps* taps, float8 weight) {
  sum->red += taps->red * weight;
  sum->green += taps->green * weight;
  sum->blue += taps->blue * weight;
  sum->coverage += taps->coverage * weight;
#if ALPHA
  sum->alpha += taps->alpha * weight;
#endif
}

static inline float8 lesser(float8 least, float8 value, int8 valid) {
  return min(least, select((float8)(FLT_MAX), value, valid));
}

static inline float8 greater(float8 most, float8 value, int8 valid) {
  return max(most, select((float8)(-FLT_MAX), value, valid));
}

static inline void widen(LayerSums* sums, const LayerTaps* taps) {
  LayerColours* least = &sums->least;
  LayerColours* most = &sums->most;
  const int8 valid = taps->valid;
  least->red = lesser(least->red, taps->red, valid);
  least->green = lesser(least->green, taps->green, valid);
  least->blue = lesser(least->blue, taps->blue, valid);
  least->coverage = lesser(least->coverage, taps->coverage, valid);
  most->red = greater(most->red, taps->red, valid);
  most->green = greater(most->green, taps->green, valid);
  most->blue = greater(most->blue, taps->blue, valid);
  most->coverage = greater(most->coverage, taps->coverage, valid);
#if ALPHA
  least->alpha = lesser(least->alpha, taps->alpha, valid);
  most->alpha = greater(most->alpha, taps->alpha, valid);
#endif
}

// Adds a texel of each pixel with its weight in the cubic.
static inline void add_taps(LayerSums* sums, const LayerTaps* taps, float8 weight) {
  const float8 counted = select((float8)(0.0f), weight, taps->valid);
  add_colours(&sums->cubic, taps, counted);
  sums->weight += counted;
  sums->stored += taps->confidence * weight;
  sums->has_two |= taps->has_two;
}

// Adds one of the middle four, too, with its weight in the bilinear blend.
static inline void add_middle_taps(LayerSums* sums, const LayerTaps* taps, float8 weight) {
  const float8 counted = select((float8)(0.0f), weight, taps->valid);
  add_colours(&sums->bilinear, taps, counted);
  sums->middle_weight += counted;
  sums->confidence += taps->confidence * counted;
  sums->least_stored = min(sums->least_stored, taps->confidence);
  sums->most_stored = max(sums->most_stored, taps->confidence);
  widen(sums, taps);
}

// One channel: the cubic, held in the range of the middle four, or bilinear.
static inline float8 blend_channel(float8 cubic, float8 bilinear, float8 least, float8 most, float8 weight,
                                   float8 middle_weight) {
  const float8 held = min(max(cubic / weight, least), most);
  const float8 blended = select(held, bilinear / middle_weight, weight < LEAST_TAPS);
  return select(blended, (float8)(0.0f), middle_weight < NO_TAPS);
}

// The cubic over the valid taps, held in the range of the middle four of those; bilinear where the cubic has lost most
// of its weights.
static inline LayerColours blend_sums(const LayerSums* sums) {
  const LayerColours *cubic = &sums->cubic, *bilinear = &sums->bilinear, *least = &sums->least, *most = &sums->most;
  const float8 w = sums->weight, m = sums->middle_weight;
  LayerColours colours;
  colours.red = blend_channel(cubic->red, bilinear->red, least->red, most->red, w, m);
  colours.green = blend_channel(cubic->green, bilinear->green, least->green, most->green, w, m);
  colours.blue = blend_channel(cubic->blue, bilinear->blue, least->blue, most->blue, w, m);
  colours.coverage = blend_channel(cubic->coverage, bilinear->coverage, least->coverage, most->coverage, w, m);
  colours.alpha = (float8)(1.0f);
#if ALPHA
  const float8 alpha = blend_channel(cubic->alpha, bilinear->alpha, least->alpha, most->alpha, w, m);
  colours.alpha = select(alpha, (float8)(1.0f), m < NO_TAPS);
#endif
  return colours;
}

// Of surfaces alone among texels of one layer it is the cubic's, as resolve_temporal has it.
static inline float8 blend_confidence(const LayerSums* sums, int8 is_alone) {
  const float8 cubic = clamp(min(max(sums->stored, sums->least_stored), sums->most_stored), 0.0f, MOST_CONFIDENCE);
  const float8 known = select(sums->confidence, (float8)(0.0f), sums->middle_weight < NO_TAPS);
  return select(known, cubic, is_alone & ~sums->has_two);
}
