// SPDX-License-Identifier: MIT
// The near layers of eight pixels of a row: history that follows the near surface, and this frame's samples added to
// it. A sample of the far surface says that nothing of the near one is there.
#pragma once

#include "layers/layer_seed.h"
#include "layers/layered_pixels.h"
#include "temporal/accumulate.h"
#include "temporal/correct_history.h"
#include "temporal/relight.h"

#define NEAR_REACH 0.6f            // of the distance between samples, at least REACH: +.2 dB on turning spokes
// Output pixels a frame: near layers of a tile whose motions differ by more may cross. Leaves under a moving camera
// differ by less: .25 loses .03 dB there, 2 loses .1 dB where cords cross.
#define CROSSING_MOTION 1.0f
#define MOST_NEAR_CONFIDENCE 8.0f  // it is resampled more often than not; 32 gives no more

// Premultiplied colours and coverages, and their confidence.
typedef struct NearLayers {
  EightTexels texels;
  float8 confidence;
} NearLayers;

// What history has of them, in this frame's light and with confidence limited. The tile's own rejection tells of the
// far layer alone; `cut`: how far
// the whole picture is another one.
static inline NearLayers fetch_near(const LayeredPixels* pixels, const PastLayers* past, DEPTH_TEXELS depth1,
                                    TexelLayout layout, LayerTile tile, int x, int y, EdgeLight left,
                                    EdgeLight right, float cut) {
  const LayerWishes wishes = near_wishes_of(pixels, tile.motion_range > CROSSING_MOTION);
  const LayerPlaces place = places_from(x, y, tile.phase_x, tile.phase_y, pixels->motion_x, pixels->motion_y);
  const LayerSources from = find_sources(past, depth1, layout, &wishes, place, tile.is_rigid);
  const FetchedLayers fetched = fetch_layers(past, depth1, layout, &wishes, &from, pixels->is_split);
  const float8 fx = from.fraction_x, fy = from.fraction_y;
  const float8 between = min(4.0f * (fx * (1.0f - fx) + fy * (1.0f - fy)), 1.0f);
  const float8 most = most_confidence(min(pixels->open_trust, 1.0f - cut));
  const float8 known = fetched.confidence / (1.0f + RESAMPLING_COST * between * fetched.confidence);
  const float8 coverage = confidences(fetched.texels);
  NearLayers near = {relight(fetched.texels, left, right), min(known, min(most, MOST_NEAR_CONFIDENCE))};
  near.texels.left.s37bf = coverage.lo;
  near.texels.right.s37bf = coverage.hi;
  return near;
}

// Reseeds those of `lanes`. Returns how much each resists this frame's sample, as a weight.
static inline float8 reseed_near(NearLayers* near, int8 lanes, const LayeredPixels* layered, COLOUR_TEXELS colour,
                                 DEPTH_TEXELS depth, TexelLayout layout, const SourceFrame* frame,
                                 const NearestSamples* nearest) {
  float4 texel[8];
  float confidence[8], inertia[8], between[8], from_x[8];
  int is_reseeded[8], x[8];
  vstore16(near->texels.left, 0, (float*)texel);
  vstore16(near->texels.right, 1, (float*)texel);
  vstore8(near->confidence, 0, confidence);
  vstore8((float8)(0.0f), 0, inertia);
  vstore8(layered->between, 0, between);
  vstore8(nearest->from_x, 0, from_x);
  vstore8(nearest->x, 0, x);
  vstore8(lanes, 0, is_reseeded);
  for (int i = 0; i < 8; ++i) {
    if (is_reseeded[i] == 0) continue;
    const LayerSamples samples = {*frame, layout, between[i]};
    const NearestSample place = {x[i], nearest->y, from_x[i], nearest->from_y};
    const Seed seed = seed_of_layer(&samples, colour, depth, kNearLayer, place);
    const float share = 1.0f - confidence[i] / LEAST_CONFIDENCE;
    texel[i] += (seed.mean - texel[i]) * share;
    inertia[i] = INERTIA * share;
    confidence[i] = seed.any ? LEAST_CONFIDENCE : 0.0f;
  }
  near->texels.left = vload16(0, (const float*)texel);
  near->texels.right = vload16(1, (const float*)texel);
  near->confidence = vload8(0, confidence);
  return vload8(0, inertia);
}

// Turns samples into what the near layers have of them. Returns their weights: 0 of those that are invalid or of no
// depth.
static inline float8 near_samples(EightTexels* samples, float8 depth, float8 between) {
  const int8 is_near = depth > between, is_far = depth < between;
  const float8 none = (float8)(0.0f), one = (float8)(1.0f);
  float8 weight = select(none, one, is_near | is_far);
  if (may_be_bright(*samples)) weigh_by_luma(samples, &weight, 8);
  const int8 counts = is_far & (weight > none);
  weight = select(weight, one, counts);  // what is not there is not bright
#if ALPHA
  const float8 coverage = select(none, confidences(*samples), is_near);
#else
  const float8 coverage = select(none, one, is_near);
#endif
  const float8 taken = select(none, one, is_near);
  samples->left *= to_four_texels(taken.lo);
  samples->right *= to_four_texels(taken.hi);
  samples->left.s37bf = coverage.lo;
  samples->right.s37bf = coverage.hi;
  return weight;
}

// The near layers of this frame. `nearest`: samples, of their pictures.
static inline NearLayers update_near(NearLayers near, const LayeredPixels* pixels, COLOUR_TEXELS colour,
                                     DEPTH_TEXELS depth, TexelLayout layout, const TemporalParams* params,
                                     const NearestSamples* nearest) {
  const SourceFrame frame = params->frame0;
  float8 inertia = (float8)(0.0f);
  const int8 unknown = pixels->is_split & (near.confidence < LEAST_CONFIDENCE);
  if (any_lane(unknown)) inertia = reseed_near(&near, unknown, pixels, colour, depth, layout, &frame, nearest);

  EightTexels samples = load_samples(colour, frame.colour, nearest->x, nearest->y);
  const float8 own = (float8)(load_depth4(depth, layout, nearest->x.lo, nearest->y),
                              load_depth4(depth, layout, nearest->x.hi, nearest->y));
  const float reach = max(NEAR_REACH * max(params->spacing_x, params->spacing_y), REACH);
  const float8 weight =
      near_samples(&samples, own, pixels->between) * distance_weights(params, nearest, (float8)(reach));
  const float8 part = sample_parts(near.confidence, inertia, weight);
  const NearLayers updated = {{near.texels.left + (samples.left - near.texels.left) * to_four_texels(part.lo),
                               near.texels.right + (samples.right - near.texels.right) * to_four_texels(part.hi)},
                              min(near.confidence + weight, MOST_NEAR_CONFIDENCE)};
  return updated;
}

// Stores those of `lanes`.
static inline void store_near(STORED_HISTORY updated, int index, EightTexels texels, int8 lanes) {
  float4 texel[8];
  int is_stored[8];
  vstore16(texels.left, 0, (float*)texel);
  vstore16(texels.right, 1, (float*)texel);
  vstore8(lanes, 0, is_stored);
  for (int i = 0; i < 8; ++i) {
    if (is_stored[i] != 0) store_history(updated, index + i, texel[i]);
  }
}
