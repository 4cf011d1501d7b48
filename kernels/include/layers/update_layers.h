// SPDX-License-Identifier: MIT
// The layers of eight pixels of a row: what history has of each, and this frame's samples added to it.
//   The far layer, or the surface that a pixel has alone, goes the way of resolve_temporal.
//   The near layer follows the near surface. A sample of the far one says that nothing of the near one is there.
#pragma once

#include "bits.h"
#include "layers/layered_pixels.h"
#include "temporal/accumulate.h"
#include "temporal/constants.h"
#include "temporal/limit_confidence.h"
#include "temporal/reprojection.h"
#include "temporal/reseed.h"

// Layers of one kind, and where they were.
typedef struct FetchedLayers {
  KnownLayers known;
  LayerSources from;
} FetchedLayers;

typedef struct BothLayers {
  FetchedLayers far, near;  // far or only ones; the near ones only where a pixel has two
} BothLayers;

// Fetches the layers of the pixels from (x, y) on. Unrolled, as rounds would hand lanes on that do not count.
static inline BothLayers fetch_both(const LayeredPixels* pixels, const PastLayers* past, DEPTH_TEXELS depth1,
                                    TileReprojection tile, LayerTile layer, const EightReprojections* motion, int x,
                                    int y) {
  BothLayers both;
  UNROLL_ALWAYS(2)
  for (int kind = kFarLayer; kind <= kNearLayer; ++kind) {
    const bool is_far = kind == kFarLayer;
    if (!is_far && !any_lane(pixels->is_split)) break;
    const LayerWishes wishes =
        is_far ? far_wishes_of(pixels) : near_wishes_of(pixels, layer.motion_range > CROSSING_MOTION_MIN);
    const LayerPlaces place =
        is_far ? places_from(x, y, tile.phase_x, tile.phase_y, motion->x, motion->y)
               : places_from(x, y, layer.phase_x, layer.phase_y, pixels->motion_x, pixels->motion_y);
    both.near.from = find_sources(past, depth1, &wishes, place, is_far ? tile.is_rigid : layer.is_rigid);
    both.near.known = fetch_layers(past, depth1, &wishes, &both.near.from, is_far ? (int8)(-1) : pixels->is_split);
    if (is_far) both.far = both.near;
  }
  return both;
}

// ---- Far layers.

// Returns them as resolve_temporal fetches them. Layers answer for depth, so trust is open where there are or were two.
static inline FetchedHistory known_far(const LayeredPixels* pixels, const FetchedLayers* far,
                                         EightReprojections* motion) {
  const KnownLayers layers = far->known;
  motion->trust = select(motion->trust, pixels->open_trust, pixels->is_split | far->from.was_split);

  const float8 coverage = confidences(layers.texels);
  const int8 is_surface = coverage > NEAR_COVERAGE_MIN;
  const float8 whole = select((float8)(0.0f), 1.0f / coverage, is_surface);
  const FetchedHistory fetched = {
      {layers.texels.left * to_four_texels(whole.lo), layers.texels.right * to_four_texels(whole.hi)},
      select((float8)(0.0f), layers.confidence, is_surface),
      far->from.fraction_x,
      far->from.fraction_y};
  return fetched;
}

// Rectifies and reseeds, as correct_history. In a pixel with two layers, only reseeds the far one, with samples of it.
static inline float8 correct_far(const LayeredPixels* pixels, COLOUR_TEXELS colour, DEPTH_TEXELS depth,
                                 TexelLayout layout, const SourceFrame* frame, const SampleMotion* sample_motion,
                                 const NearestSamples* nearest, EightTexels* history, float8* alpha,
                                 Evidence* evidence) {
  const float8 inertia =
      correct_history(colour, frame, sample_motion, nearest, ~pixels->is_split, history, alpha, evidence);
  const int8 unknown = pixels->is_split & (evidence->confidence < CONFIDENCE_MIN);
  if (!any_lane(unknown)) return inertia;
  const float8 reseeded = reseed_layer(kFarLayer, unknown, pixels, colour, depth, layout, frame, nearest, history,
                                       alpha, &evidence->confidence);
  return select(inertia, reseeded, unknown);
}

// Returns 1 for samples that are added to the far, or only, layer, else 0.
static inline float8 far_samples(const LayeredPixels* pixels) {
  return select((float8)(1.0f), (float8)(0.0f), pixels->is_split & ~(pixels->depth < pixels->between));
}

// Gives the confidences of pixels of two layers a minus sign.
static inline void mark_split(EightTexels* texels, int8 is_split) {
  const int8 signs = is_split & INT_MIN;
  texels->left.s37bf = as_float4(as_int4(texels->left.s37bf) | signs.lo);
  texels->right.s37bf = as_float4(as_int4(texels->right.s37bf) | signs.hi);
}

// ---- Near layers.

// Returns them in this frame's light, with their confidence limited. The tile's own rejection tells of the far layer
// alone; `cut`: how far the whole picture is another one.
static inline KnownLayers known_near(const LayeredPixels* pixels, const FetchedLayers* fetched, RowLight light,
                                       float cut) {
  KnownLayers near = fetched->known;
  const float8 between = between_texels(fetched->from.fraction_x, fetched->from.fraction_y);
  const float8 most = most_confidence(min(pixels->open_trust, 1.0f - cut));
  near.confidence = min(after_resampling(near.confidence, between), min(most, RESAMPLED_CONFIDENCE_MAX));
  const float8 coverage = confidences(near.texels);
  near.texels = relight(near.texels, light);
  near.texels.left.s37bf = coverage.lo;
  near.texels.right.s37bf = coverage.hi;
  return near;
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

// Reseeds near layers, and adds this frame's samples. `nearest`: those nearest to their pictures.
static inline KnownLayers update_near(KnownLayers near, const LayeredPixels* pixels, COLOUR_TEXELS colour,
                                      DEPTH_TEXELS depth, TexelLayout layout, const TemporalParams* params,
                                      const NearestSamples* nearest) {
  const SourceFrame frame = params->frame0;
  float8 inertia = (float8)(0.0f);
  const int8 unknown = pixels->is_split & (near.confidence < CONFIDENCE_MIN);
  if (any_lane(unknown))
    inertia = reseed_layer(kNearLayer, unknown, pixels, colour, depth, layout, &frame, nearest, &near.texels,
                           &near.alpha, &near.confidence);

  EightTexels samples = load_samples(colour, frame.colour, nearest->x, nearest->y);
  const float8 own = (float8)(load_depth4(depth, layout, nearest->x.lo, nearest->y),
                              load_depth4(depth, layout, nearest->x.hi, nearest->y));
  const float reach = max(NEAR_REACH * max(params->spacing_x, params->spacing_y), WIDE_REACH);
  const float8 weight =
      near_samples(&samples, own, pixels->between) * distance_weights(params, nearest, (float8)(reach));
  const float8 part = sample_parts(near.confidence, inertia, weight);
  near.texels.left += (samples.left - near.texels.left) * to_four_texels(part.lo);
  near.texels.right += (samples.right - near.texels.right) * to_four_texels(part.hi);
  near.confidence = min(near.confidence + weight, RESAMPLED_CONFIDENCE_MAX);
  return near;
}

// Stores those of `lanes`.
static inline void store_near(STORED_HISTORY updated, int index, EightTexels texels, int8 lanes) {
  for (int i = 0; i < kLanes; ++i) {
    const float4 texel = first_texel(texels);
    if (lanes.s0 != 0) store_history(updated, index + i, texel);
    texels = push_texel(texels, texel);
    lanes = NEXT_LANES(lanes);
  }
}
