// SPDX-License-Identifier: MIT
// For resolve_checkerboard: the colours of pixels that are not shaded.
#pragma once

#include "bits.h"
#include "checkerboard/pasts.h"

#define LEAST_DIFFERENCE 1e-30f  // squared: two pairs that are equal count alike
#define MOST_DIFFERENCE 1e18f    // its square is finite

static inline GroupChannels non_finite_channels(GroupTexels value) {
#if LANES == 8
  return (as_int16(value) & 0x7fffffff) >= NON_FINITE_BITS;
#else
  return non_finite_lanes(value);
#endif
}

static inline bool any_is_lost(LaneTexels colours) {
#if LANES == 8
  const int16 lost = non_finite_channels(colours.left) | non_finite_channels(colours.right);
  return any_of_eight(lost.lo | lost.hi);
#else
  return any_non_finite4(colours);
#endif
}

// In all channels of each pixel whether one is set.
static inline GroupChannels in_any_channel(GroupChannels lanes) {
#if LANES == 8
  const int16 pairs = lanes | lanes.s1032547698badcfe;
  return pairs | pairs.s23016745ab89efcd;
#else
  return (int4)(any(lanes) ? -1 : 0);
#endif
}

// The neighbours of a group of pixels. Where one is missing, outside or not finite, another stands in for it, so that
// the range of the four and the mean of both pairs are those of the ones that are there; all are 0 where there is none.
typedef struct ColoursAround {
  GroupTexels left, right, above, below;
  GroupChannels is_missing;  // one or more
} ColoursAround;

static inline ColoursAround stand_in(ColoursAround c, GroupMask left, GroupMask right, GroupMask above,
                                     GroupMask below) {
  const GroupTexels none = (GroupTexels)(0.0f);
  const GroupChannels has_left = MASK_IN_CHANNELS(left) & ~in_any_channel(non_finite_channels(c.left));
  const GroupChannels has_right = MASK_IN_CHANNELS(right) & ~in_any_channel(non_finite_channels(c.right));
  const GroupChannels has_above = MASK_IN_CHANNELS(above) & ~in_any_channel(non_finite_channels(c.above));
  const GroupChannels has_below = MASK_IN_CHANNELS(below) & ~in_any_channel(non_finite_channels(c.below));
  const GroupTexels first_across = select(none, select(c.right, c.left, has_left), has_left | has_right);
  const GroupTexels first_down = select(none, select(c.below, c.above, has_above), has_above | has_below);
  const GroupTexels last_across = select(first_across, c.right, has_right);
  const GroupTexels last_down = select(first_down, c.below, has_below);
  ColoursAround found;
  found.left = select(first_down, first_across, has_left | has_right);
  found.right = select(last_down, last_across, has_left | has_right);
  found.above = select(first_across, first_down, has_above | has_below);
  found.below = select(last_across, last_down, has_above | has_below);
  found.is_missing = ~(has_left & has_right & has_above & has_below);
  return found;
}

// The neighbours of the pixels in all lanes.
typedef struct LanesAround {
  ColoursAround left;
#if LANES == 8
  ColoursAround right;
#endif
} LanesAround;

static inline LanesAround colours_around(const CheckerboardParams* params, ColourBits left, ColourBits right,
                                         ColourBits above, ColourBits below, int x, int y) {
  const LaneTexels l = colours_of(left), r = colours_of(right), a = colours_of(above), b = colours_of(below);
  const GroupChannels none = (GroupChannels)(0);
  LanesAround around;
  around.left = (ColoursAround){LEFT_TEXELS(l), LEFT_TEXELS(r), LEFT_TEXELS(a), LEFT_TEXELS(b), none};
#if LANES == 8
  around.right = (ColoursAround){RIGHT_TEXELS(l), RIGHT_TEXELS(r), RIGHT_TEXELS(a), RIGHT_TEXELS(b), none};
#endif
  const LaneTexels sums = BOTH((LEFT_TEXELS(l) + LEFT_TEXELS(r)) + (LEFT_TEXELS(a) + LEFT_TEXELS(b)),
                               (RIGHT_TEXELS(l) + RIGHT_TEXELS(r)) + (RIGHT_TEXELS(a) + RIGHT_TEXELS(b)));
  if (all_inside(params, x, y) && !any_is_lost(sums)) return around;
  const InsideAround inside = inside_around(params, x, y);
  around.left = stand_in(around.left, LEFT(inside.left), LEFT(inside.right), LEFT(inside.above), LEFT(inside.below));
#if LANES == 8
  around.right =
      stand_in(around.right, RIGHT(inside.left), RIGHT(inside.right), RIGHT(inside.above), RIGHT(inside.below));
#endif
  return around;
}

// The sum over the channels of each pixel, in all of them.
static inline GroupTexels over_channels(GroupTexels value) {
#if LANES == 8
  const float16 pairs = value + value.s1032547698badcfe;
  return pairs + pairs.s23016745ab89efcd;
#else
  const float4 pairs = value + value.s1032;
  return pairs + pairs.s2301;
#endif
}

// Squared.
static inline GroupTexels difference_of(GroupTexels a, GroupTexels b) {
  const GroupTexels apart = clamp(a - b, -MOST_DIFFERENCE, MOST_DIFFERENCE);
  return over_channels(apart * apart);
}

// The mean of left and right, and that of above and below, by the squared difference of the other pair.
static inline GroupTexels mean_along_edge(ColoursAround c) {
  const GroupTexels by_across = difference_of(c.above, c.below) + LEAST_DIFFERENCE;
  const GroupTexels by_down = difference_of(c.left, c.right) + LEAST_DIFFERENCE;
  const GroupTexels part = select(by_across / (by_across + by_down), (GroupTexels)(0.5f), c.is_missing);
  return (c.left + c.right) * 0.5f * part + (c.above + c.below) * 0.5f * (1.0f - part);
}

#if LANES == 8
static inline float16 load_four_colours_at(const CheckerboardParams* params, COLOUR_TEXELS previous, int4 x, int4 y) {
  const TexelLayout layout = params->previous_colour;
  return (float16)(load_stored(previous, layout, x.s0, y.s0), load_stored(previous, layout, x.s1, y.s1),
                   load_stored(previous, layout, x.s2, y.s2), load_stored(previous, layout, x.s3, y.s3));
}
#endif

// Previous colours that lie anywhere.
static inline LaneTexels load_colours_at(const CheckerboardParams* params, COLOUR_TEXELS previous, LaneInt x,
                                         LaneInt y) {
#if LANES == 8
  const LaneTexels texels = {load_four_colours_at(params, previous, x.lo, y.lo),
                             load_four_colours_at(params, previous, x.hi, y.hi)};
  return texels;
#else
  return load_stored(previous, params->previous_colour, x, y);
#endif
}

// The previous colours at the places, bilinear. Not finite where one of the texels that count is not.
IN_REGISTERS static inline LaneTexels previous_colours(const CheckerboardParams* params, COLOUR_TEXELS previous,
                                                       Places places) {
  const LaneFloat column = places.column.fraction, row = places.row.fraction;
#if SOURCE_STORAGE == BUFFER && LANES == 8
  if (places.are_a_run) {
    const int x = places.column.low.s0, above = upper_row(params, places), below = lower_row(params, places);
    const TexelLayout layout = params->previous_colour;
    const ColourRun upper = load_colour_run(previous, layout, x, above);
    const ColourRun lower = load_colour_run(previous, layout, x, below);
    const LaneTexels held = move_to(move_to(colours_of(upper.even), colours_of(upper.odd), column),
                                    move_to(colours_of(lower.even), colours_of(lower.odd), column), row);
    if (!any_is_lost(held)) return held;  // else a texel may count that has no part in it
  }
#endif
  const LaneInt left = lower_texel(places.column, params->previous_width);
  const LaneInt right = upper_texel(places.column, params->previous_width);
  const LaneInt above = lower_texel(places.row, params->previous_height);
  const LaneInt below = upper_texel(places.row, params->previous_height);
  const LaneTexels upper = move_to(load_colours_at(params, previous, left, above),
                                   load_colours_at(params, previous, right, above), column);
  const LaneTexels lower = move_to(load_colours_at(params, previous, left, below),
                                   load_colours_at(params, previous, right, below), column);
  return move_to(upper, lower, row);
}

// Within the neighbours' range.
static inline GroupTexels in_range(ColoursAround around, GroupTexels colour) {
  const GroupTexels low = min(min(around.left, around.right), min(around.above, around.below));
  const GroupTexels high = max(max(around.left, around.right), max(around.above, around.below));
  return clamp(colour, low, high);
}

// The previous colours, in range, as far as they are trusted and finite; over the rest.
static inline GroupTexels over_rest(ColoursAround around, GroupTexels held, GroupFloats trust, GroupTexels rest) {
  const GroupTexels none = (GroupTexels)(0.0f);
  const GroupChannels lost = in_any_channel(non_finite_channels(held));
  const GroupTexels part = select(IN_CHANNELS(trust), none, lost);
  return in_range(around, select(held, none, lost)) * part + rest * (1.0f - part);
}

IN_REGISTERS static inline LaneTexels lanes_over_rest(LanesAround around, LaneTexels held, LaneFloat trust,
                                                      LaneTexels rest) {
  const LaneTexels laid =
      BOTH(over_rest(around.left, LEFT_TEXELS(held), LEFT(trust), LEFT_TEXELS(rest)),
           over_rest(around.right, RIGHT_TEXELS(held), RIGHT(trust), RIGHT_TEXELS(rest)));
  return laid;
}

static inline LaneTexels fill_colours(const CheckerboardParams* params, COLOUR_TEXELS previous, LanesAround around,
                                      Past nearest, Past farthest) {
  LaneTexels held = no_texels();
  if (any_lane(nearest.trust > 0.0f)) {
    held = previous_colours(params, previous, nearest.places);
    if (!any_lane(nearest.trust < 1.0f) && !any_is_lost(held)) {
      const LaneTexels filled =
          BOTH(in_range(around.left, LEFT_TEXELS(held)), in_range(around.right, RIGHT_TEXELS(held)));
      return filled;
    }
  }
  LaneTexels filled = BOTH(mean_along_edge(around.left), mean_along_edge(around.right));
  farthest.trust = select(farthest.trust, (LaneFloat)(0.0f), nearest.trust >= 1.0f);
  if (any_lane(farthest.trust > 0.0f))
    filled = lanes_over_rest(around, previous_colours(params, previous, farthest.places), farthest.trust, filled);
  return lanes_over_rest(around, held, nearest.trust, filled);
}
