// SPDX-License-Identifier: MIT
// For resolve_checkerboard: the colours of eight pixels that are not shaded.
#pragma once

#include "bits.h"
#include "checkerboard/pasts.h"

#define LEAST_DIFFERENCE 1e-30f  // squared: two pairs that are equal count alike
#define MOST_DIFFERENCE 1e18f    // its square is finite

static inline int16 non_finite_channels(float16 value) {
  return (as_int16(value) & 0x7fffffff) >= NON_FINITE_BITS;
}

static inline bool any_channel(int16 lanes) {
  return any_of_eight(lanes.lo | lanes.hi);
}

static inline bool any_is_lost(EightColours colours) {
  return any_channel(non_finite_channels(colours.first) | non_finite_channels(colours.last));
}

// In all channels of each of four pixels whether one is set.
static inline int16 in_any_channel(int16 lanes) {
  const int16 pairs = lanes | lanes.s1032547698badcfe;
  return pairs | pairs.s23016745ab89efcd;
}

// The neighbours of four pixels. Where one is missing, outside or not finite, another stands in for it, so that the
// range of the four and the mean of both pairs are those of the ones that are there; all are 0 where there is none.
typedef struct ColoursAround {
  float16 left, right, above, below;
  int16 is_missing;  // one or more
} ColoursAround;

static inline ColoursAround stand_in(ColoursAround c, int4 left, int4 right, int4 above, int4 below) {
  const int16 has_left = OF_FOUR(left) & ~in_any_channel(non_finite_channels(c.left));
  const int16 has_right = OF_FOUR(right) & ~in_any_channel(non_finite_channels(c.right));
  const int16 has_above = OF_FOUR(above) & ~in_any_channel(non_finite_channels(c.above));
  const int16 has_below = OF_FOUR(below) & ~in_any_channel(non_finite_channels(c.below));
  const float16 first_across = select((float16)(0.0f), select(c.right, c.left, has_left), has_left | has_right);
  const float16 first_down = select((float16)(0.0f), select(c.below, c.above, has_above), has_above | has_below);
  const float16 last_across = select(first_across, c.right, has_right);
  const float16 last_down = select(first_down, c.below, has_below);
  ColoursAround found;
  found.left = select(first_down, first_across, has_left | has_right);
  found.right = select(last_down, last_across, has_left | has_right);
  found.above = select(first_across, first_down, has_above | has_below);
  found.below = select(last_across, last_down, has_above | has_below);
  found.is_missing = ~(has_left & has_right & has_above & has_below);
  return found;
}

// Those of eight pixels.
typedef struct EightAround {
  ColoursAround first, last;
} EightAround;

static inline EightAround colours_around(const CheckerboardParams* params, ColourBits left, ColourBits right,
                                         ColourBits above, ColourBits below, int x, int y) {
  const EightColours l = colours_of(left), r = colours_of(right), a = colours_of(above), b = colours_of(below);
  EightAround around = {{l.first, r.first, a.first, b.first, (int16)(0)}, {l.last, r.last, a.last, b.last, (int16)(0)}};
  const EightColours sums = {(l.first + r.first) + (a.first + b.first), (l.last + r.last) + (a.last + b.last)};
  if (all_inside(params, x, y) && !any_is_lost(sums)) return around;
  const InsideAround inside = inside_around(params, x, y);
  around.first = stand_in(around.first, inside.left.lo, inside.right.lo, inside.above.lo, inside.below.lo);
  around.last = stand_in(around.last, inside.left.hi, inside.right.hi, inside.above.hi, inside.below.hi);
  return around;
}

// The sum over the channels of each of four pixels, in all of them.
static inline float16 over_channels(float16 value) {
  const float16 pairs = value + value.s1032547698badcfe;
  return pairs + pairs.s23016745ab89efcd;
}

// Squared.
static inline float16 difference_of(float16 a, float16 b) {
  const float16 apart = clamp(a - b, -MOST_DIFFERENCE, MOST_DIFFERENCE);
  return over_channels(apart * apart);
}

// The mean of left and right, and that of above and below, by the squared difference of the other pair.
static inline float16 mean_along_edge(ColoursAround c) {
  const float16 by_across = difference_of(c.above, c.below) + LEAST_DIFFERENCE;
  const float16 by_down = difference_of(c.left, c.right) + LEAST_DIFFERENCE;
  const float16 part = select(by_across / (by_across + by_down), (float16)(0.5f), c.is_missing);
  return (c.left + c.right) * 0.5f * part + (c.above + c.below) * 0.5f * (1.0f - part);
}

static inline float16 mix_colours(float16 low, float16 high, float16 fraction) {
  return low + (high - low) * fraction;
}

// Four previous colours that lie anywhere.
static inline float16 load_colours_at(const CheckerboardParams* params, COLOUR_TEXELS previous, int4 x, int4 y) {
  const TexelLayout layout = params->previous_colour;
  return (float16)(load_stored(previous, layout, x.s0, y.s0), load_stored(previous, layout, x.s1, y.s1),
                   load_stored(previous, layout, x.s2, y.s2), load_stored(previous, layout, x.s3, y.s3));
}

static inline float16 colours_between(const CheckerboardParams* params, COLOUR_TEXELS previous, int4 left, int4 right,
                                      int4 above, int4 below, float4 column, float4 row) {
  const float16 upper = mix_colours(load_colours_at(params, previous, left, above),
                                    load_colours_at(params, previous, right, above), OF_FOUR(column));
  const float16 lower = mix_colours(load_colours_at(params, previous, left, below),
                                    load_colours_at(params, previous, right, below), OF_FOUR(column));
  return mix_colours(upper, lower, OF_FOUR(row));
}

// The previous colours at eight places, bilinear. Not finite where one of the texels that count is not.
IN_REGISTERS static inline EightColours previous_colours(const CheckerboardParams* params, COLOUR_TEXELS previous,
                                                         Places places) {
  const float8 column = places.column.fraction, row = places.row.fraction;
#if SOURCE_STORAGE == BUFFER
  if (LANES == 8 && places.are_a_run) {
    const int x = places.column.low.s0, above = upper_row(params, places), below = lower_row(params, places);
    const TexelLayout layout = params->previous_colour;
    const ColourRun upper = load_colour_run(previous, layout, x, above);
    const ColourRun lower = load_colour_run(previous, layout, x, below);
    const EightColours ul = colours_of(upper.even), ur = colours_of(upper.odd);
    const EightColours ll = colours_of(lower.even), lr = colours_of(lower.odd);
    const EightColours held = {
        mix_colours(mix_colours(ul.first, ur.first, OF_FOUR(column.lo)),
                    mix_colours(ll.first, lr.first, OF_FOUR(column.lo)), OF_FOUR(row.lo)),
        mix_colours(mix_colours(ul.last, ur.last, OF_FOUR(column.hi)),
                    mix_colours(ll.last, lr.last, OF_FOUR(column.hi)), OF_FOUR(row.hi))};
    if (!any_is_lost(held)) return held;  // else a texel may count that has no part in it
  }
#endif
  const int8 left = lower_texel(places.column, params->previous_width);
  const int8 right = upper_texel(places.column, params->previous_width);
  const int8 above = lower_texel(places.row, params->previous_height);
  const int8 below = upper_texel(places.row, params->previous_height);
  const EightColours held = {
      colours_between(params, previous, left.lo, right.lo, above.lo, below.lo, column.lo, row.lo),
      colours_between(params, previous, left.hi, right.hi, above.hi, below.hi, column.hi, row.hi)};
  return held;
}

// Within the neighbours' range.
static inline float16 in_range(ColoursAround around, float16 colour) {
  const float16 low = min(min(around.left, around.right), min(around.above, around.below));
  const float16 high = max(max(around.left, around.right), max(around.above, around.below));
  return clamp(colour, low, high);
}

// The previous colours, in range, as far as they are trusted and finite; over the rest.
static inline float16 over_rest(ColoursAround around, float16 held, float4 trust, float16 rest) {
  const int16 lost = in_any_channel(non_finite_channels(held));
  const float16 part = select(OF_FOUR(trust), (float16)(0.0f), lost);
  return in_range(around, select(held, (float16)(0.0f), lost)) * part + rest * (1.0f - part);
}

IN_REGISTERS static inline EightColours eight_over_rest(EightAround around, EightColours held, float8 trust,
                                                        EightColours rest) {
  const EightColours laid = {over_rest(around.first, held.first, trust.lo, rest.first),
                             over_rest(around.last, held.last, trust.hi, rest.last)};
  return laid;
}

static inline EightColours fill_colours(const CheckerboardParams* params, COLOUR_TEXELS previous, EightAround around,
                                        Past nearest, Past farthest) {
  EightColours held = {(float16)(0.0f), (float16)(0.0f)};
  if (any_of_eight(nearest.trust > 0.0f)) {
    held = previous_colours(params, previous, nearest.places);
    if (!any_of_eight(nearest.trust < 1.0f) && !any_is_lost(held)) {
      const EightColours filled = {in_range(around.first, held.first), in_range(around.last, held.last)};
      return filled;
    }
  }
  EightColours filled = {mean_along_edge(around.first), mean_along_edge(around.last)};
  farthest.trust = select(farthest.trust, (float8)(0.0f), nearest.trust >= 1.0f);
  if (any_of_eight(farthest.trust > 0.0f))
    filled = eight_over_rest(around, previous_colours(params, previous, farthest.places), farthest.trust, filled);
  return eight_over_rest(around, held, nearest.trust, filled);
}
