// SPDX-License-Identifier: MIT
// Eight output pixels of a row, each with one layer or two.
#pragma once

#include "layers/fetch_layers.h"
#include "temporal/nearest_samples.h"

// What the samples nearest to them say.
typedef struct LayeredPixels {
  int8 is_split;                 // lanes with two layers
  float8 near_depth, far_depth;  // of their layers; of a surface alone the near one is its own
  float8 motion_x, motion_y;     // of the near layer
  float8 between;                // a depth between the layers
  float8 depth;                  // of the sample
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

// `may_cross`: one of the tile's near layers may cross another that is nearly as deep.
static inline LayerWishes near_wishes_of(const LayeredPixels* pixels, bool may_cross) {
  const LayerWishes wishes = {kNearLayer,
                              pixels->is_split,
                              pixels->near_depth,
                              pixels->far_depth,
                              may_cross ? 1.0f - CROSSING_DEPTHS : 0.0f,
                              1.0f + (may_cross ? CROSSING_DEPTHS : NEAR_DEPTHS)};
  return wishes;
}

// Where the pixels from (x, y) on come from, with a phase and motions.
static inline LayerPlaces places_from(int x, int y, float phase_x, float phase_y, float8 motion_x, float8 motion_y) {
  const float8 columns = (float8)(0.5f, 1.5f, 2.5f, 3.5f, 4.5f, 5.5f, 6.5f, 7.5f);
  const LayerPlaces places = {((float)x + columns + phase_x) + motion_x, ((float)y + 0.5f + phase_y) + motion_y};
  return places;
}
