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
  const LayerWishes wishes = wishes_of(pixels, kFarLayer);
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

// Rectifies and reseeds, as correct_history. Of a pixel with two layers, only reseeds the far one, with samples of it.
static inline float8 correct_layers(const LayeredPixels* layered, COLOUR_TEXELS colour, DEPTH_TEXELS depth,
                                    TexelLayout layout, const SourceFrame* frame, const SampleMotion* sample_motion,
                                    const NearestSamples* nearest, EightTexels* history, float8* alpha,
                                    Evidence* evidence) {
  EightPixels pixels = load_pixels(nearest, history, *alpha, evidence);
  int is_split[8];
  float between[8];
  vstore8(layered->is_split, 0, is_split);
  vstore8(layered->between, 0, between);
  for (int i = 0; i < 8; ++i) {
    if (is_split[i] == 0) {
      correct_pixel(colour, frame, sample_motion, &pixels, i, nearest->y, nearest->from_y);
      continue;
    }
    pixels.inertia[i] = 0.0f;
    if (pixels.confidence[i] >= LEAST_CONFIDENCE) continue;
    const LayerSamples samples = {*frame, layout, between[i]};
    const NearestSample place = {pixels.x[i], nearest->y, pixels.from_x[i], nearest->from_y};
    const Seed seed = seed_of_layer(&samples, colour, depth, kFarLayer, place);
    if (!seed.any) continue;
    const float share = 1.0f - pixels.confidence[i] / LEAST_CONFIDENCE;
    pixels.history[i] += (seed.mean - pixels.history[i]) * share;
#if ALPHA
    pixels.alpha[i] += (seed.mean.w - pixels.alpha[i]) * share;
#endif
    pixels.inertia[i] = INERTIA * share;
    pixels.confidence[i] = LEAST_CONFIDENCE;
  }
  return take_pixels(&pixels, history, alpha, evidence);
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
