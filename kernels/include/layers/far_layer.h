// SPDX-License-Identifier: MIT
// The far layers of eight pixels of a row, or the surfaces that they have alone.
#pragma once

#include "layers/layer_seed.h"
#include "layers/layered_pixels.h"
#include "temporal/correct_history.h"
#include "temporal/reprojection.h"

// As resolve_temporal's fetch_history. Layers answer for depth, so trust is open where there are or were two.
static inline FetchedHistory fetch_far(const LayeredPixels* pixels, const PastLayers* past, DEPTH_TEXELS depth1,
                                       TexelLayout layout, TileReprojection tile, int x, int y,
                                       EightReprojections* motion, float8* alpha) {
  const LayerWishes wishes = far_wishes_of(pixels);
  const LayerPlaces place = places_from(x, y, tile.phase_x, tile.phase_y, motion->x, motion->y);
  const LayerSources from = find_sources(past, depth1, layout, &wishes, place, tile.is_rigid);
  const FetchedLayers layers = fetch_layers(past, depth1, layout, &wishes, &from, (int8)(-1));
  motion->trust = select(motion->trust, pixels->open_trust, pixels->is_split | from.was_split);
  *alpha = layers.alpha;

  const float8 coverage = confidences(layers.texels);
  const float8 solid = select((float8)(0.0f), 1.0f / coverage, coverage > SOLID);
  const FetchedHistory fetched = {
      {layers.texels.left * to_four_texels(solid.lo), layers.texels.right * to_four_texels(solid.hi)},
      select((float8)(0.0f), layers.confidence, coverage > SOLID),
      from.fraction_x,
      from.fraction_y};
  return fetched;
}

// Reseeds far layers of `lanes` with samples of theirs. Returns their inertia.
static inline float8 reseed_far(int8 lanes, const LayeredPixels* layered, COLOUR_TEXELS colour, DEPTH_TEXELS depth,
                                TexelLayout layout, const SourceFrame* frame, const NearestSamples* nearest,
                                EightTexels* history, float8* alpha, float8* known) {
  float4 texel[8];
  float confidence[8], inertia[8], between[8], from_x[8], alphas[8];
  int is_reseeded[8], x[8];
  vstore16(history->left, 0, (float*)texel);
  vstore16(history->right, 1, (float*)texel);
  vstore8(*known, 0, confidence);
  vstore8((float8)(0.0f), 0, inertia);
  vstore8(layered->between, 0, between);
  vstore8(nearest->from_x, 0, from_x);
  vstore8(*alpha, 0, alphas);
  vstore8(nearest->x, 0, x);
  vstore8(lanes, 0, is_reseeded);
  for (int i = 0; i < 8; ++i) {
    if (is_reseeded[i] == 0) continue;
    const LayerSamples samples = {*frame, layout, between[i]};
    const NearestSample place = {x[i], nearest->y, from_x[i], nearest->from_y};
    const Seed seed = seed_of_layer(&samples, colour, depth, kFarLayer, place);
    if (!seed.any) continue;
    const float share = 1.0f - confidence[i] / LEAST_CONFIDENCE;
    texel[i] += (seed.mean - texel[i]) * share;
    alphas[i] += (seed.mean.w - alphas[i]) * share;
    inertia[i] = INERTIA * share;
    confidence[i] = LEAST_CONFIDENCE;
  }
  history->left = vload16(0, (const float*)texel);
  history->right = vload16(1, (const float*)texel);
  *known = vload8(0, confidence);
#if ALPHA
  *alpha = vload8(0, alphas);
#endif
  return vload8(0, inertia);
}

// Rectifies and reseeds, as correct_history. Of a pixel with two layers, only reseeds the far one, with samples of it.
static inline float8 correct_layers(const LayeredPixels* layered, COLOUR_TEXELS colour, DEPTH_TEXELS depth,
                                    TexelLayout layout, const SourceFrame* frame, const SampleMotion* sample_motion,
                                    const NearestSamples* nearest, EightTexels* history, float8* alpha,
                                    Evidence* evidence) {
  const float8 inertia = correct_history(colour, frame, sample_motion, nearest, ~layered->is_split, history, alpha,
                                         evidence);
  const int8 unknown = layered->is_split & (evidence->confidence < LEAST_CONFIDENCE);
  if (!any_lane(unknown)) return inertia;
  return select(inertia, reseed_far(unknown, layered, colour, depth, layout, frame, nearest, history, alpha,
                                    &evidence->confidence), unknown);
}

// 1 of samples that are added to the far, or only, layer, else 0.
static inline float8 far_samples(const LayeredPixels* pixels) {
  return select((float8)(1.0f), (float8)(0.0f), pixels->is_split & ~(pixels->depth < pixels->between));
}

// The confidences of pixels of two layers with a minus sign.
static inline void mark_split(EightTexels* texels, int8 is_split) {
  const int8 signs = is_split & INT_MIN;
  texels->left.s37bf = as_float4(as_int4(texels->left.s37bf) | signs.lo);
  texels->right.s37bf = as_float4(as_int4(texels->right.s37bf) | signs.hi);
}
