// SPDX-License-Identifier: MIT
// The samples of this frame, one at a time or one for each of eight pixels. A sample that is not finite, or as large as
// a half can be, is invalid and takes no part.
#pragma once

#include "arithmetic.h"
#include "temporal/constants.h"
#include "temporal/history.h"
#include "temporal/temporal_params.h"
#include "texel.h"

#define INVALID_BITS 0x477fe000  // bits of 65504, the largest half: what a half target holds of anything brighter

static inline bool is_valid(float4 sample) {
  const long2 hits = as_long2((as_int4(sample) & 0x7fffffff) >= INVALID_BITS);
  return (hits.x | hits.y) == 0;
}

// Returns in each channel of four samples whether that sample is valid.
static inline int16 are_valid(float16 samples) {
  const int16 magnitude = as_int16(samples) & 0x7fffffff;
  const int16 pairs = max(magnitude, magnitude.s1032547698badcfe);
  return max(pairs, pairs.s23016745ab89efcd) < INVALID_BITS;
}

static inline float largest_colour(float4 colour) {
  return max(max(colour.x, colour.y), max(colour.z, 0.0f));
}

// Returns sample (x, y), clamped to the viewport's edge.
static inline float4 sample_at(COLOUR_TEXELS texels, const SourceFrame* frame, int x, int y) {
  return load_colour(texels, frame->colour, clamp(x, 0, frame->width - 1), clamp(y, 0, frame->height - 1));
}

static inline void load_next_sample(COLOUR_TEXELS texels, TexelLayout layout, int8* x, int y, EightTexels* samples) {
  *samples = push_texel(*samples, load_colour(texels, layout, x->s0, y));
  *x = NEXT_LANES(*x);
}

// Loads the samples of a row nearest to eight pixels.
static inline EightTexels load_samples(COLOUR_TEXELS texels, TexelLayout layout, int8 x, int y) {
#if SOURCE_STORAGE == BUFFER && SOURCE_FORMAT == HALF && ON_CPU
  return gather_half_texels((__global const ulong*)texels + row_index(layout, y), x);
#else
  EightTexels samples = no_texels();
  EACH_LANE(load_next_sample(texels, layout, &x, y, &samples));
  return samples;
#endif
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

// What is compared of eight samples.
typedef struct SampleLanes {
  float8 luma;                // negative channels included
  float8 brightest, darkest;  // channels of colour
  int8 valid;
} SampleLanes;

static inline float8 luma_of(EightTexels texels) {
  return 0.25f * (reds(texels) + blues(texels)) + 0.5f * greens(texels);
}

static inline int8 magnitude_bits(float8 value) {
  return as_int8(value) & 0x7fffffff;
}

static inline SampleLanes compare_lanes(EightTexels samples) {
  const float8 red = reds(samples), green = greens(samples), blue = blues(samples);
  const int8 largest = max(max(magnitude_bits(red), magnitude_bits(green)),
                           max(magnitude_bits(blue), magnitude_bits(last_channels(samples))));
  const SampleLanes lanes = {luma_of(samples), max(max(red, green), blue), min(min(red, green), blue),
                             largest < INVALID_BITS};
  return lanes;
}

// Limits beyond which samples are outliers.
typedef struct OutlierRange {
  float8 most, least;
} OutlierRange;

static inline OutlierRange outlier_range(EightTexels history) {
  const float8 light = max(max(fabs(reds(history)), fabs(greens(history))), fabs(blues(history)));
  const OutlierRange range = {OUTLIER_RATIO_MIN * (light + OUTLIER_FLOOR), -(light + NEGATIVE_OUTLIER_FLOOR)};
  return range;
}

// Returns which samples are valid and outliers.
static inline int8 are_outliers(const SampleLanes* samples, OutlierRange range) {
  return samples->valid & ((samples->brightest > range.most) | (samples->darkest < range.least));
}

// ---- The sample of this frame nearest to each of eight output pixels of a row, in one tile.

// Nearest samples. A pixel's picture lies at its centre + the tile's phase. All eight share their row, as y's lanes do.
typedef struct NearestSamples {
  int8 x;        // columns of the viewport
  int y;         // row
  // From the sample to the pixel's picture, in samples; beyond the outermost samples more than half of one.
  float8 from_x;
  float from_y;
  Positions between_x, between_y;  // the same place, clamped to the viewport: between which samples it lies
} NearestSamples;

// Returns the place of output row y, without a phase.
static inline Positions row_position(const TemporalParams* params, __global const int* positions, int y) {
  const int texel = positions[2 * params->columns + y];
  const float fraction = as_float(positions[2 * params->columns + params->output_height + y]);
  const Positions row = {(int8)(texel), (float8)(fraction)};
  return row;
}

// Moves, on a checkerboard, from a sample that is not shaded to the next one of its row that is, on the pixel's own
// side where there is one.
static inline void move_to_shaded(NearestSamples* nearest, const TemporalParams* params) {
  const int last = params->frame0.width - 1;
  const int8 is_shaded = ((nearest->x + nearest->y) & 1) == params->parity;
  int8 step = select((int8)(-1), (int8)(1), nearest->from_x > 0.0f);
  step = select(step, (int8)(1), nearest->x == 0);
  step = select(step, (int8)(-1), nearest->x == last);
  step = select(step, (int8)(0), is_shaded | (int8)(last == 0 ? -1 : 0));
  nearest->x += step;
  nearest->from_x -= convert_float8(step);
}

// Finds the nearest samples of the pixels from column x on, in a row that is not known yet.
static inline NearestSamples find_nearest_columns(const TemporalParams* params, __global const int* positions, int x,
                                                  TileReprojection tile) {
  Positions place = load_positions(positions, params->columns, x);
  if (tile.phase_x != 0.0f || tile.phase_y != 0.0f)
    place = shifted_positions(place, (float8)(tile.phase_x / params->spacing_x));
  NearestSamples nearest;
  nearest.between_x = held_positions(place, params->frame0.width - 1);
  nearest.x = nearest_samples(nearest.between_x);
  nearest.from_x = place.fraction + convert_float8(place.texel - nearest.x);
  return nearest;
}

// Returns them in a row.
static inline NearestSamples in_row(const TemporalParams* params, NearestSamples nearest, Positions row,
                                    TileReprojection tile) {
  Positions place = row;
  if (tile.phase_x != 0.0f || tile.phase_y != 0.0f)
    place = shifted_positions(row, (float8)(tile.phase_y / params->spacing_y));
  nearest.between_y = held_positions(place, params->frame0.height - 1);
  nearest.y = nearest_samples(nearest.between_y).s0;
  nearest.from_y = place.fraction.s0 + (float)(place.texel.s0 - nearest.y);
  if (params->parity >= 0) move_to_shaded(&nearest, params);
  return nearest;
}

// Finds the nearest samples of the pixels from column x on, in a row.
static inline NearestSamples find_nearest_samples(const TemporalParams* params, __global const int* positions, int x,
                                                  Positions row, TileReprojection tile) {
  return in_row(params, find_nearest_columns(params, positions, x, tile), row, tile);
}
