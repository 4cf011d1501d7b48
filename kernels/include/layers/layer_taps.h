// SPDX-License-Identifier: MIT
// What texels of history have of the layers that eight pixels of a row want: one texel of each at a time.
#pragma once

#include "layers/layer_row.h"

#define NEAR_DEPTHS 0.1f       // of the larger depth: a near layer of another depth is another thing's
#define CROSSING_DEPTHS 0.05f  // the same of near layers that may cross: those that do are close together
#define FAR_DEPTHS 0.2f        // the same of a far layer, which may be seen at a slant
#define SOLID 0.3f             // coverage from which a near layer may stand for a surface alone
#define EMPTY_CONFIDENCE 1.0f  // at most: that there is no near layer where there was but one

typedef enum LayerKind {
  kFarLayer,   // of split pixels the far layer, of the others the surface that they have alone
  kNearLayer,  // of split pixels
} LayerKind;

// What eight pixels want of history.
typedef struct LayerWishes {
  LayerKind kind;
  int8 is_split;                 // lanes with two layers
  float8 near_depth, far_depth;  // of a surface alone its own depth and any
  float least_part, most_part;   // of a near layer's depth: texels within that range show the same thing
} LayerWishes;

// Of each pixel one texel as the layer has it: premultiplied colour and coverage, confidence, and whether it is the
// surface that is wished for.
typedef struct LayerTaps {
  float8 red, green, blue, coverage, confidence;
  float8 alpha;  // with ALPHA: of the far layer; a near one is opaque where it covers
  int8 has_two;  // it has two layers
  int8 valid;
} LayerTaps;

static inline int8 are_alike(float8 a, float8 b, float tolerance) {
  return fabs(a - b) <= tolerance * max(a, b);
}

// Of a texel for each pixel. `tests_depth`: lanes of surfaces alone whose texels of one layer must not be nearer, as no
// trust tells.
static inline LayerTaps far_taps(const EightLayers* texels, const LayerWishes* wishes, int8 tests_depth) {
  const float8 far_depth = texels->far_depth, near_depth = texels->near_depth;
  const float8 stored = texels->confidence, coverage = texels->coverage;
  const float8 confidence = min(fabs(stored), MOST_CONFIDENCE);
  const int8 split = wishes->is_split, two = as_int8(stored) >> 31;
  const float8 wanted = select(wishes->near_depth, wishes->far_depth, split);
  const int8 is_near = two & (wanted > 0.5f * (far_depth + near_depth));
  const float8 shown = select(far_depth, near_depth, is_near);
  const int8 known = confidence > 0.0f;

  const int8 far_valid = (shown >= wanted * (1.0f - FAR_DEPTHS)) &
                         (shown <= 0.5f * (wishes->near_depth + wishes->far_depth)) &
                         select(known, coverage >= SOLID, is_near);
  const int8 alone_valid = select(~tests_depth | (far_depth <= wanted * (1.0f + FAR_DEPTHS)),
                                  select(known & are_alike(shown, wanted, FAR_DEPTHS),
                                         are_alike(shown, wanted, NEAR_DEPTHS), is_near), two);

  const float8 solid = select((float8)(1.0f), 1.0f / max(coverage, (float8)(SOLID)), split);
  LayerTaps taps;
  taps.red = select(texels->red, texels->near_red * solid, is_near);
  taps.green = select(texels->green, texels->near_green * solid, is_near);
  taps.blue = select(texels->blue, texels->near_blue * solid, is_near);
  taps.coverage = select((float8)(1.0f), coverage, is_near & ~split);
  taps.confidence = select(confidence, texels->near_confidence * coverage, is_near);
  taps.alpha = select(texels->alpha, (float8)(1.0f), is_near);
  taps.has_two = two;
  taps.valid = select(alone_valid, far_valid, split);
  return taps;
}

static inline LayerTaps near_taps(const EightLayers* texels, const LayerWishes* wishes) {
  const float8 far_depth = texels->far_depth, near_depth = texels->near_depth;
  const float8 stored = texels->confidence;
  const float8 confidence = min(fabs(stored), MOST_CONFIDENCE);
  const int8 two = as_int8(stored) >> 31;
  const int8 is_near = two & (wishes->near_depth > 0.5f * (far_depth + near_depth));
  const float8 shown = select(far_depth, near_depth, is_near);
  const int8 is_ours = (shown > 0.5f * (wishes->near_depth + wishes->far_depth)) &
                       (shown >= wishes->near_depth * wishes->least_part);
  const float8 nothing = (float8)(0.0f);
  const float8 little = min(confidence, EMPTY_CONFIDENCE);

  LayerTaps taps;
  taps.red = select(nothing, select(texels->red, texels->near_red, is_near), is_ours);
  taps.green =
      select(nothing, select(texels->green, texels->near_green, is_near), is_ours);
  taps.blue =
      select(nothing, select(texels->blue, texels->near_blue, is_near), is_ours);
  taps.coverage = select(nothing, select((float8)(1.0f), texels->coverage, is_near), is_ours);
  taps.confidence = select(select(little, confidence, is_ours & ~two), texels->near_confidence,
                           is_ours & is_near);
  taps.alpha = (float8)(1.0f);
  taps.has_two = two;
  taps.valid = shown <= wishes->near_depth * wishes->most_part;  // nothing stood before it
  return taps;
}
