// SPDX-License-Identifier: MIT
// Eight output pixels of a row, each with one layer or two, and their far, or only, layers.
#pragma once

#include "layers/near_layer.h"
#include "layers/split.h"
#include "temporal/nearest_samples.h"
#include "temporal/reprojection.h"

// Of eight pixels.
typedef struct LayeredPixels {
  LayerSplit split[8];
  float depth[8];  // of the nearest sample
  int x[8];        // and its column
  float motion_x[8], motion_y[8], trust[8], open_trust[8];
  float4 history[8];
  float confidence[8], fraction_x[8], fraction_y[8];
  float alpha[8];
} LayeredPixels;

// The samples nearest to the pixels.
static inline void find_layers(LayeredPixels* pixels, DEPTH_TEXELS depth, const LayerPastParams* past,
                               const TemporalParams* params, __global const LayerSplit* splits,
                               __global const float* open_trust, const NearestSamples* nearest,
                               const EightReprojections* motion) {
  vstore8(nearest->x, 0, pixels->x);
  vstore8(motion->x, 0, pixels->motion_x);
  vstore8(motion->y, 0, pixels->motion_y);
  vstore8(motion->trust, 0, pixels->trust);
  for (int i = 0; i < 8; ++i) {
    const int sample = nearest->y * params->frame0.width + pixels->x[i];
    pixels->split[i] = splits[sample];
    pixels->open_trust[i] = max(open_trust[sample], 0.0f);
    pixels->depth[i] = load_depth(depth, past->depth0, pixels->x[i], nearest->y);
  }
}

// History of the far layers, and of pixels that have but one.
static inline void fetch_far(LayeredPixels* pixels, const PastLayers* past, DEPTH_TEXELS depth1, TexelLayout layout,
                             TileReprojection tile, int x, int y) {
  for (int i = 0; i < 8; ++i) {
    const LayerSplit split = pixels->split[i];
    const float2 place = (float2)((float)(x + i) + 0.5f + tile.phase_x, (float)y + 0.5f + tile.phase_y) +
                         (float2)(pixels->motion_x[i], pixels->motion_y[i]);
    const LayerWish alone = {kOneLayer, pixels->depth[i], 0.0f, false};
    const LayerWish far = {kFarLayer, split.near_depth, split.far_depth, false};
    const LayerTexel texel = fetch_layer(past, depth1, layout, is_split(split) ? far : alone, place, tile.is_rigid);
    const bool known = texel.value.w > SOLID;
    pixels->history[i] = known ? texel.value / texel.value.w : (float4)(0.0f);
    pixels->confidence[i] = known ? texel.confidence : 0.0f;
    pixels->fraction_x[i] = texel.fraction.x;
    pixels->fraction_y[i] = texel.fraction.y;
    pixels->alpha[i] = texel.alpha;
    // Layers answer for depth.
    if (is_split(split) || texel.was_split) pixels->trust[i] = pixels->open_trust[i];
  }
}

static inline FetchedHistory fetched_of(const LayeredPixels* pixels) {
  FetchedHistory fetched;
  fetched.texels.left = vload16(0, (const float*)pixels->history);
  fetched.texels.right = vload16(1, (const float*)pixels->history);
  fetched.confidence = vload8(0, pixels->confidence);
  fetched.fraction_x = vload8(0, pixels->fraction_x);
  fetched.fraction_y = vload8(0, pixels->fraction_y);
  return fetched;
}

// Rectifies and reseeds. Of a pixel with two layers, only reseeds the far one, with samples of it.
static inline float8 correct_layers(const LayeredPixels* layered, COLOUR_TEXELS colour, DEPTH_TEXELS depth,
                                    TexelLayout depth_layout, const SourceFrame* frame,
                                    const SampleMotion* sample_motion, const NearestSamples* nearest,
                                    EightTexels* history, float8* alpha, Evidence* evidence) {
  EightPixels pixels;
  vstore16(history->left, 0, (float*)pixels.history);
  vstore16(history->right, 1, (float*)pixels.history);
  vstore8(evidence->confidence, 0, pixels.confidence);
  vstore8(evidence->rejection, 0, pixels.rejection);
  vstore8(nearest->from_x, 0, pixels.from_x);
  vstore8(nearest->x, 0, pixels.x);
  vstore8(*alpha, 0, pixels.alpha);
  for (int i = 0; i < 8; ++i) {
    if (!is_split(layered->split[i])) {
      correct_pixel(colour, frame, sample_motion, &pixels, i, nearest->y, nearest->from_y);
      continue;
    }
    pixels.inertia[i] = 0.0f;
    const float w = pixels.confidence[i];
    if (w >= LEAST_CONFIDENCE) continue;
    const LayerSamples samples = {*frame, depth_layout, between_of(layered->split[i])};
    const NearPlace place = {pixels.x[i], nearest->y, pixels.from_x[i], nearest->from_y};
    const NearTexel seed = seed_layer(&samples, colour, depth, true, place);
    if (seed.confidence == 0.0f) continue;
    const float share = 1.0f - w / LEAST_CONFIDENCE;
    pixels.history[i] += (seed.value - pixels.history[i]) * share;
    pixels.alpha[i] += (seed.value.w - pixels.alpha[i]) * share;
    pixels.inertia[i] = INERTIA * share;
    pixels.confidence[i] = LEAST_CONFIDENCE;
  }
  history->left = vload16(0, (const float*)pixels.history);
  history->right = vload16(1, (const float*)pixels.history);
  evidence->confidence = vload8(0, pixels.confidence);
  *alpha = vload8(0, pixels.alpha);
  return vload8(0, pixels.inertia);
}

// 1 of samples that are added to the far, or only, layer, else 0.
static inline float8 far_samples(const LayeredPixels* pixels) {
  float taken[8];
  for (int i = 0; i < 8; ++i) {
    const LayerSplit split = pixels->split[i];
    taken[i] = !is_split(split) || pixels->depth[i] < between_of(split) ? 1.0f : 0.0f;
  }
  return vload8(0, taken);
}

static inline float8 whole_pixels(const LayeredPixels* pixels) {
  float whole[8];
  for (int i = 0; i < 8; ++i) whole[i] = is_split(pixels->split[i]) ? 0.0f : 1.0f;
  return vload8(0, whole);
}

// Stores the confidences of pixels of two layers with a minus sign.
static inline void mark_split(EightTexels* texels, float8 whole) {
  const int8 signs = select((int8)(INT_MIN), (int8)(0), whole > 0.0f);
  const int16 left = (int16)(0, 0, 0, signs.s0, 0, 0, 0, signs.s1, 0, 0, 0, signs.s2, 0, 0, 0, signs.s3);
  const int16 right = (int16)(0, 0, 0, signs.s4, 0, 0, 0, signs.s5, 0, 0, 0, signs.s6, 0, 0, 0, signs.s7);
  texels->left = as_float16(as_int16(texels->left) | left);
  texels->right = as_float16(as_int16(texels->right) | right);
}
