// SPDX-License-Identifier: MIT
// Eight output pixels of a row, each with one layer or two: what this frame's samples around them say.
#pragma once

#include "arithmetic.h"
#include "layers/fetch_layers.h"
#include "temporal/constants.h"
#include "temporal/frame_samples.h"
#include "temporal/reseed.h"

// Eight pixels as the samples nearest to them say.
typedef struct LayeredPixels {
  int8 is_split;                 // lanes with two layers
  float8 near_depth, far_depth;  // depths of their layers; for a surface alone the near one is its own
  float8 motion_x, motion_y;     // motion of the near layer
  float8 between;                // a depth between the layers
  float8 depth;                  // the sample's own
  float8 open_trust;
} LayeredPixels;

static inline LayeredPixels find_layers(DEPTH_TEXELS depth, TexelLayout layout, const TemporalParams* params,
                                        __global const LayerSplit* splits, __global const float* open_trust,
                                        const NearestSamples* nearest) {
  const int8 x = nearest->x;
  const int first = nearest->y * params->frame0.width;
  __global const float* split = (__global const float*)(splits + first);
  __global const float* trust = open_trust + first;
  const float4 s0 = vload4(x.s0, split), s1 = vload4(x.s1, split), s2 = vload4(x.s2, split), s3 = vload4(x.s3, split);
  const float4 s4 = vload4(x.s4, split), s5 = vload4(x.s5, split), s6 = vload4(x.s6, split), s7 = vload4(x.s7, split);
  const float8 near = (float8)(s0.x, s1.x, s2.x, s3.x, s4.x, s5.x, s6.x, s7.x);
  LayeredPixels pixels;
  pixels.depth = (float8)(load_depth4(depth, layout, x.lo, nearest->y), load_depth4(depth, layout, x.hi, nearest->y));
  pixels.is_split = near > 0.0f;
  pixels.near_depth = select(pixels.depth, near, pixels.is_split);
  pixels.far_depth = (float8)(s0.y, s1.y, s2.y, s3.y, s4.y, s5.y, s6.y, s7.y);
  pixels.motion_x = (float8)(s0.z, s1.z, s2.z, s3.z, s4.z, s5.z, s6.z, s7.z);
  pixels.motion_y = (float8)(s0.w, s1.w, s2.w, s3.w, s4.w, s5.w, s6.w, s7.w);
  pixels.between = 0.5f * (near + pixels.far_depth);
  pixels.open_trust = max((float8)(trust[x.s0], trust[x.s1], trust[x.s2], trust[x.s3], trust[x.s4], trust[x.s5],
                                   trust[x.s6], trust[x.s7]), (float8)(0.0f));
  return pixels;
}

static inline LayerWishes far_wishes_of(const LayeredPixels* pixels) {
  const LayerWishes wishes = {kFarLayer, pixels->is_split, pixels->near_depth, pixels->far_depth, 0.0f, 1.0f};
  return wishes;
}

// Returns the wishes of near layers of a tile where `may_cross`: another one that is nearly as deep may cross them.
static inline LayerWishes near_wishes_of(const LayeredPixels* pixels, bool may_cross) {
  const LayerWishes wishes = {kNearLayer,
                              pixels->is_split,
                              pixels->near_depth,
                              pixels->far_depth,
                              may_cross ? 1.0f - CROSSING_DEPTH_STEP_MAX : 0.0f,
                              1.0f + (may_cross ? CROSSING_DEPTH_STEP_MAX : NEAR_DEPTH_STEP_MAX)};
  return wishes;
}

// Returns where the pixels from (x, y) on come from, with a phase and motions.
static inline LayerPlaces places_from(int x, int y, float phase_x, float phase_y, float8 motion_x, float8 motion_y) {
  const float8 columns = (float8)(0.5f, 1.5f, 2.5f, 3.5f, 4.5f, 5.5f, 6.5f, 7.5f);
  const LayerPlaces places = {((float)x + columns + phase_x) + motion_x, ((float)y + 0.5f + phase_y) + motion_y};
  return places;
}

// ---- Seeds: what this frame's samples around a pixel show of a layer.

// This frame's samples around a pixel.
typedef struct SeedSamples {
  SourceFrame frame;
  TexelLayout depth;
  int x, y;              // the one nearest to its picture
  float from_x, from_y;  // from there to its picture, in samples
} SeedSamples;

typedef struct Seed {
  float4 mean;  // alpha in w
  bool any;     // whether any sample is the layer's and valid; else the mean is 0
} Seed;

// Returns the Gaussian of the 3x3 samples, clamped to the edge: of the far layer's, those behind the depth `between`;
// or of all valid ones as the near layer has them, in which one of the far layer's says that nothing of the near one is
// there.
static inline Seed seed_of_layer(const SeedSamples* in, COLOUR_TEXELS colour, DEPTH_TEXELS depth, LayerKind kind,
                                 float between) {
  float4 sum = (float4)(0.0f);
  float weights = 0.0f;
  for (int i = 0; i < 9; ++i) {
    const int column = i % 3 - 1, row = i / 3 - 1;
    const int x = clamp(in->x + column, 0, in->frame.width - 1), y = clamp(in->y + row, 0, in->frame.height - 1);
    float4 sample = load_colour(colour, in->frame.colour, x, y);
    const float own = load_depth(depth, in->depth, x, y);
    const bool is_near = own > between, is_far = own < between;
    if (!is_valid(sample) || !(is_far || (is_near && kind == kNearLayer))) continue;
    if (kind == kNearLayer) {
      if (!ALPHA) sample.w = 1.0f;
      if (is_far) sample = (float4)(0.0f);
    }
    const float away_x = (float)column - in->from_x, away_y = (float)row - in->from_y;
    const float weight = bell((float8)((away_x * away_x + away_y * away_y) * SEED_FALLOFF)).s0 * luma_weight(sample);
    sum += sample * weight;
    weights += weight;
  }
  const Seed seed = {weights > 0.0f ? sum / weights : (float4)(0.0f), weights > 0.0f};
  return seed;
}

// Reseeds the layers of `lanes` with samples of theirs. A far layer stays what it is where there is none. Returns their
// inertia: how much each resists this frame's sample, as a weight.
static inline float8 reseed_layer(LayerKind kind, int8 lanes, const LayeredPixels* pixels, COLOUR_TEXELS colour,
                                  DEPTH_TEXELS depth, TexelLayout layout, const SourceFrame* frame,
                                  const NearestSamples* nearest, EightTexels* history, float8* alpha, float8* known) {
  float8 inertia = (float8)(0.0f), between = pixels->between, from_x = nearest->from_x;
  int8 x = nearest->x;
  for (int i = 0; i < kLanes; ++i) {
    float4 texel = first_texel(*history);
    if (lanes.s0 != 0) {
      const SeedSamples samples = {*frame, layout, x.s0, nearest->y, from_x.s0, nearest->from_y};
      const Seed seed = seed_of_layer(&samples, colour, depth, kind, between.s0);
      if (seed.any || kind == kNearLayer) {
        const float share = 1.0f - known->s0 / CONFIDENCE_MIN;
        texel += (seed.mean - texel) * share;
#if ALPHA
        alpha->s0 += (seed.mean.w - alpha->s0) * share;
#endif
        inertia.s0 = SEED_INERTIA * share;
        known->s0 = seed.any ? CONFIDENCE_MIN : 0.0f;
      }
    }
    *history = push_texel(*history, texel);
    *alpha = NEXT_LANES(*alpha);
    *known = NEXT_LANES(*known);
    inertia = NEXT_LANES(inertia);
    lanes = NEXT_LANES(lanes);
    between = NEXT_LANES(between);
    from_x = NEXT_LANES(from_x);
    x = NEXT_LANES(x);
  }
  return inertia;
}
