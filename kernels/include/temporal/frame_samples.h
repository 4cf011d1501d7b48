// SPDX-License-Identifier: MIT
// The samples of this frame in exposed light, one at a time or one for each lane. A sample with NaN in it, or light of
// -65504 or less, is invalid and takes no part. What is brighter than history can hold, infinity too, counts as the
// brightest that it can.
#pragma once

#include "arithmetic.h"
#include "picture_params.h"
#include "temporal/constants.h"
#include "temporal/history.h"
#include "temporal/temporal_params.h"
#include "texel.h"

#define INVALID_BITS 0x477fe000   // bits of 65504, the largest half
#define INFINITY_BITS 0x7f800000

// A frame whose colour is read as exposed light.
typedef struct ExposedFrame {
  int width, height;
  TexelLayout colour;
  float exposure;  // Exposure's factor
} ExposedFrame;

static inline ExposedFrame expose(SourceFrame frame, __global const Exposure* exposure) {
  const ExposedFrame exposed = {frame.width, frame.height, frame.colour, exposure->factor};
  return exposed;
}

// Returns samples with each channel that is too bright as the largest float below 65504, which halves round to that.
#define DEFINE_HELD(name, floats, ints, as_floats, as_ints)                          \
  static inline floats name(floats samples) {                                        \
    const ints bits = as_ints(samples);                                              \
    const ints too_bright = (bits >= INVALID_BITS) & (bits <= INFINITY_BITS);        \
    return as_floats(select(bits, (ints)(INVALID_BITS - 1), too_bright));            \
  }
DEFINE_HELD(held_sample, float4, int4, as_float4, as_int4)
#if LANES == 8
DEFINE_HELD(held_four, float16, int16, as_float16, as_int16)
#endif

static inline LaneTexels held_samples(LaneTexels samples) {
#if LANES == 8
  const LaneTexels held = {held_four(samples.left), held_four(samples.right)};
  return held;
#else
  return held_sample(samples);
#endif
}

static inline bool is_valid(float4 sample) {
  const long2 hits = as_long2((as_int4(sample) & 0x7fffffff) >= INVALID_BITS);
  return (hits.x | hits.y) == 0;
}

static inline float largest_colour(float4 colour) {
  return max(max(colour.x, colour.y), max(colour.z, 0.0f));
}

// Returns sample (x, y), clamped to the viewport's edge.
static inline float4 sample_at(COLOUR_TEXELS texels, const ExposedFrame* frame, int x, int y) {
  const float4 sample =
      load_colour(texels, frame->colour, clamp(x, 0, frame->width - 1), clamp(y, 0, frame->height - 1));
  return held_sample((float4)(sample.xyz * frame->exposure, sample.w));
}

static inline void load_next_sample(COLOUR_TEXELS texels, TexelLayout layout, LaneInt* x, LaneInt* y,
                                    LaneTexels* samples) {
  *samples = push_texel(*samples, load_colour(texels, layout, FIRST_LANE(*x), FIRST_LANE(*y)));
  *x = NEXT_LANES(*x);
  *y = NEXT_LANES(*y);
}

// Alpha stays.
static inline LaneTexels exposed(LaneTexels texels, float exposure) {
#if LANES == 8
  const float16 factors = select((float16)(exposure), (float16)(1.0f), LAST_CHANNELS);
  const LaneTexels products = {texels.left * factors, texels.right * factors};
  return products;
#else
  return (float4)(texels.xyz * exposure, texels.w);
#endif
}

// Loads samples of any brightness.
static inline LaneTexels load_samples_at(COLOUR_TEXELS texels, const ExposedFrame* frame, LaneInt x, LaneInt y) {
#if SOURCE_STORAGE == BUFFER && SOURCE_FORMAT == HALF
  const LaneTexels samples = gather_half_texels(texels, frame->colour.offset + y * frame->colour.pitch + x);
#else
  LaneTexels samples = no_texels();
  EACH_LANE(load_next_sample(texels, frame->colour, &x, &y, &samples));
#endif
  return exposed(samples, frame->exposure);
}

// The same of one row, whose address is found once: 3 % of resolve_temporal.
static inline LaneTexels load_samples(COLOUR_TEXELS texels, const ExposedFrame* frame, LaneInt x, int y) {
#if SOURCE_STORAGE == BUFFER && SOURCE_FORMAT == HALF
  return exposed(gather_half_texels(texels + 4 * row_index(frame->colour, y), x), frame->exposure);
#else
  return load_samples_at(texels, frame, x, (LaneInt)(y));
#endif
}

// Returns false only if none is brighter than 2 or invalid, so that their luma weights are all 1.
static inline bool may_be_bright(LaneTexels samples) {
  return any_at_least_two(any_bits(samples));
}

// Returns the luma weight of a valid sample: 1 up to a brightest channel of 2 and less beyond, so that one bright
// sample does not outshine the others. (Worth .65 dB over the laboratory's sequences, 3.6 on sparkles:
// docs/lab/temporal.md.)
static inline float luma_weight(float4 sample) {
  return 1.0f / max(1.0f, 0.5f * largest_colour(sample));
}

// ---- Outliers are samples so much brighter than history, or so negative, that they may be faults of the renderer.
// Several side by side are held back for a frame: a fault of one frame then never reaches history, and what stays, or
// comes back soon, is late by one frame.

// What is compared of samples.
typedef struct SampleLanes {
  LaneFloat luma;                // negative channels included
  LaneFloat brightest, darkest;  // channels of colour
  LaneMask valid;
} SampleLanes;

static inline LaneFloat luma_of(LaneTexels texels) {
  return 0.25f * (reds(texels) + blues(texels)) + 0.5f * greens(texels);
}

// Returns which samples are valid.
static inline LaneMask are_valid(LaneTexels samples) {
  return max(max(magnitude_bits(reds(samples)), magnitude_bits(greens(samples))),
             max(magnitude_bits(blues(samples)), magnitude_bits(last_channels(samples)))) < INVALID_BITS;
}

static inline SampleLanes compare_lanes(LaneTexels any_samples) {
  const LaneTexels samples = held_samples(any_samples);
  const LaneFloat red = reds(samples), green = greens(samples), blue = blues(samples);
  const SampleLanes lanes = {luma_of(samples), max(max(red, green), blue), min(min(red, green), blue),
                             are_valid(samples)};
  return lanes;
}

// Limits beyond which samples are outliers.
typedef struct OutlierRange {
  LaneFloat most, least;
} OutlierRange;

static inline OutlierRange outlier_range(LaneTexels history) {
  const LaneFloat light = max(max(fabs(reds(history)), fabs(greens(history))), fabs(blues(history)));
  const OutlierRange range = {OUTLIER_RATIO_MIN * (light + OUTLIER_FLOOR), -(light + NEGATIVE_OUTLIER_FLOOR)};
  return range;
}

// Returns which samples are valid and outliers.
static inline LaneMask are_outliers(const SampleLanes* samples, OutlierRange range) {
  return samples->valid & ((samples->brightest > range.most) | (samples->darkest < range.least));
}

// ---- The sample of this frame nearest to each of some output pixels of a row, in one tile.

// Nearest samples. A pixel's picture lies at its centre + the tile's phase. All share their row, as y's lanes do.
typedef struct NearestSamples {
  LaneInt x;        // columns of the viewport
  int y;         // row
  // From the sample to the pixel's picture, in samples; beyond the outermost samples more than half of one.
  LaneFloat from_x;
  float from_y;
  Positions between_x, between_y;  // the same place, clamped to the viewport: between which samples it lies
} NearestSamples;

// Returns the place of output row y, without a phase.
static inline Positions row_position(const TemporalParams* params, __global const int* positions, int y) {
  const int texel = positions[2 * params->columns + y];
  const float fraction = as_float(positions[2 * params->columns + params->output_height + y]);
  const Positions row = {(LaneInt)(texel), (LaneFloat)(fraction)};
  return row;
}

// Moves, on a checkerboard, from a sample that is not shaded to the next one of its row that is, on the pixel's own
// side where there is one.
static inline void move_to_shaded(NearestSamples* nearest, const TemporalParams* params) {
  const int last = params->frame0.width - 1;
  const LaneMask is_shaded = ((nearest->x + nearest->y) & 1) == params->parity;
  LaneInt step = select((LaneInt)(-1), (LaneInt)(1), nearest->from_x > 0.0f);
  step = select(step, (LaneInt)(1), nearest->x == 0);
  step = select(step, (LaneInt)(-1), nearest->x == last);
  step = select(step, (LaneInt)(0), is_shaded | mask_of(last == 0));
  nearest->x += step;
  nearest->from_x -= to_lane_float(step);
}

// Finds the nearest samples of the pixels from column x on, in a row that is not known yet.
static inline NearestSamples find_nearest_columns(const TemporalParams* params, __global const int* positions, int x,
                                                  TileReprojection tile) {
  Positions place = load_positions(positions, params->columns, x);
  if (tile.phase_x != 0.0f || tile.phase_y != 0.0f)
    place = shifted_positions(place, (LaneFloat)(tile.phase_x / params->spacing_x));
  NearestSamples nearest;
  nearest.between_x = held_positions(place, params->frame0.width - 1);
  nearest.x = nearest_samples(nearest.between_x);
  nearest.from_x = place.fraction + to_lane_float(place.texel - nearest.x);
  return nearest;
}

// Returns them in a row.
static inline NearestSamples in_row(const TemporalParams* params, NearestSamples nearest, Positions row,
                                    TileReprojection tile) {
  Positions place = row;
  if (tile.phase_x != 0.0f || tile.phase_y != 0.0f)
    place = shifted_positions(row, (LaneFloat)(tile.phase_y / params->spacing_y));
  nearest.between_y = held_positions(place, params->frame0.height - 1);
  nearest.y = FIRST_LANE(nearest_samples(nearest.between_y));
  nearest.from_y = FIRST_LANE(place.fraction) + (float)(FIRST_LANE(place.texel) - nearest.y);
  if (params->parity >= 0) move_to_shaded(&nearest, params);
  return nearest;
}

// Finds the nearest samples of the pixels from column x on, in a row.
static inline NearestSamples find_nearest_samples(const TemporalParams* params, __global const int* positions, int x,
                                                  Positions row, TileReprojection tile) {
  return in_row(params, find_nearest_columns(params, positions, x, tile), row, tile);
}
