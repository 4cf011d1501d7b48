// SPDX-License-Identifier: MIT
// Adds this frame's samples to the layers of pixels of a row.
//   The far layer, or the only one of a pixel, takes the steps of resolve_temporal.
//   The near layer follows the near surface. A sample of the far surface is one of coverage 0.
#pragma once

#include "arithmetic.h"
#include "bits.h"
#include "layers/fetch_layers.h"
#include "temporal/accumulate.h"
#include "temporal/constants.h"
#include "temporal/frame_samples.h"
#include "temporal/limit_confidence.h"
#include "temporal/reprojection.h"
#include "temporal/reseed.h"

// ---- Pixels as this frame's samples around them say.

// Pixels as the samples nearest to them say.
typedef struct LayeredPixels {
  LaneMask is_split;                // lanes with two layers
  LaneFloat near_depth, far_depth;  // depths of their layers; for a surface alone the near one is its own
  LaneFloat motion_x, motion_y;     // motion of the near layer
  LaneFloat between;                // a depth between the layers
  LaneFloat depth;                  // the sample's own
  LaneFloat open_trust;
} LayeredPixels;

enum { kSamplesAhead = 8 };  // to prefetch of 16-byte values; twice as many of smaller ones

// What is known of the samples beyond those of a tile's row is read soon: the next tile of the list is most often the
// next one of the picture.
static inline void will_read_samples(const TemporalParams* params, COLOUR_TEXELS colour,
                                     __global const float* reprojection, DEPTH_TEXELS depth, TexelLayout layout,
                                     __global const float* open_trust, __global const LayerSplit* splits,
                                     const NearestSamples* nearest) {
  const int x = FIRST_LANE(nearest->x) + kSamplesAhead, y = nearest->y;
  WILL_READ(splits + y * params->frame0.width + x);
  WILL_READ(reprojection + 4 * texel_index(params->reprojection, x, y));
  WILL_READ(open_trust + y * params->frame0.width + x + kSamplesAhead);
  will_read_colour(colour, params->frame0.colour, x + kSamplesAhead, y);
#if SOURCE_STORAGE == BUFFER
  WILL_READ(depth + texel_index(layout, x + kSamplesAhead, y));
#endif
}

static inline LayeredPixels find_layers(DEPTH_TEXELS depth, TexelLayout layout, const TemporalParams* params,
                                        __global const LayerSplit* splits, __global const float* open_trust,
                                        const NearestSamples* nearest, LaneMask is_split) {
  const int first = nearest->y * params->frame0.width;
  const LaneFloat4 split = gather4((__global const float*)(splits + first), nearest->x);
  const LaneFloat none = (LaneFloat)(0.0f);
  LayeredPixels pixels;
  pixels.depth = load_depth_lanes(depth, layout, nearest->x, nearest->y);
  pixels.is_split = is_split;
  pixels.near_depth = select(pixels.depth, split.x, is_split);
  pixels.far_depth = select(none, split.y, is_split);
  pixels.motion_x = select(none, split.z, is_split);
  pixels.motion_y = select(none, split.w, is_split);
  pixels.between = 0.5f * (select(none, split.x, is_split) + pixels.far_depth);
  pixels.open_trust = fabs(gather(open_trust + first, nearest->x));
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
static inline LayerPlaces places_from(int x, int y, float phase_x, float phase_y, LaneFloat motion_x,
                                      LaneFloat motion_y) {
  const LaneFloat columns = to_lane_float(LANE_NUMBERS) + 0.5f;
  const LayerPlaces places = {((float)x + columns + phase_x) + motion_x, ((float)y + 0.5f + phase_y) + motion_y};
  return places;
}

// ---- Seeds: what this frame's samples around a pixel show of a layer.

// This frame's samples around a pixel.
typedef struct SeedSamples {
  ExposedFrame frame;
  TexelLayout depth;
  int x, y;              // the one nearest to its picture
  float from_x, from_y;  // from there to its picture, in samples
} SeedSamples;

typedef struct Seed {
  float4 mean;  // w: coverage
  float alpha;
  bool any;     // whether any sample is the layer's and valid; else the mean is 0
} Seed;

// Returns the Gaussian of the 3x3 samples, clamped to the edge: of the far layer's, those behind the depth `between`;
// or of all valid ones as the near layer has them, in which one of the far layer's says that nothing of the near one is
// there.
static inline Seed seed_of_layer(const SeedSamples* in, COLOUR_TEXELS colour, DEPTH_TEXELS depth, LayerKind kind,
                                 float between) {
  float4 sum = (float4)(0.0f);
  float alpha = 0.0f, weights = 0.0f;
  for (int i = 0; i < 9; ++i) {
    const int column = i % 3 - 1, row = i / 3 - 1;
    const int x = clamp(in->x + column, 0, in->frame.width - 1), y = clamp(in->y + row, 0, in->frame.height - 1);
    float4 sample = sample_at(colour, &in->frame, x, y);
    const float own = load_depth(depth, in->depth, x, y);
    const bool is_near = own > between, is_far = own < between;
    if (!is_valid(sample) || !(is_far || (is_near && kind == kNearLayer))) continue;
    float own_alpha = sample.w;
    sample.w = 1.0f;
    if (kind == kNearLayer && is_far) {
      sample = (float4)(0.0f);
      own_alpha = 0.0f;
    }
    const float away_x = (float)column - in->from_x, away_y = (float)row - in->from_y;
    const LaneFloat near = bell((LaneFloat)((away_x * away_x + away_y * away_y) * SEED_FALLOFF));
    const float weight = FIRST_LANE(near) * luma_weight(sample);
    sum += sample * weight;
    alpha += own_alpha * weight;
    weights += weight;
  }
  const bool any = weights > 0.0f;
  const Seed seed = {any ? sum / weights : (float4)(0.0f), any ? alpha / weights : 0.0f, any};
  return seed;
}

// Moves the alphas of layers of `lanes` into the range of those of their own among the 3x3 samples around the nearest
// ones. Coverage apart, a layer's alpha is even.
static inline LaneFloat follow_layer_alphas(LayerKind kind, LaneMask lanes, const LayeredPixels* pixels,
                                            COLOUR_TEXELS colour, DEPTH_TEXELS depth, TexelLayout layout,
                                            const ExposedFrame* frame, const NearestSamples* nearest,
                                            LaneFloat alphas) {
  LaneFloat between = pixels->between;
  LaneInt x = nearest->x;
  for (int i = 0; i < kLanes; ++i) {
    if (FIRST_LANE(lanes)) {
      AlphaRange range = no_alphas();
      for (int j = 0; j < 9; ++j) {
        const int column = clamp(FIRST_LANE(x) + j % 3 - 1, 0, frame->width - 1);
        const int row = clamp(nearest->y + j / 3 - 1, 0, frame->height - 1);
        const float4 sample = sample_at(colour, frame, column, row);
        const float own = load_depth(depth, layout, column, row);
        const bool is_own = kind == kNearLayer ? own > FIRST_LANE(between) : own < FIRST_LANE(between);
        if (is_own && is_valid(sample)) add_to_range(&range, sample.w);
      }
      if (range.least <= range.most) FIRST_LANE(alphas) = follow_alpha(FIRST_LANE(alphas), range, 0.0f);
    }
    alphas = NEXT_LANES(alphas);
    lanes = NEXT_LANES(lanes);
    between = NEXT_LANES(between);
    x = NEXT_LANES(x);
  }
  return alphas;
}

// Reseeds the layers of `lanes` with samples of theirs. A far layer stays what it is where there is none. Returns their
// inertia: how much each resists this frame's sample, as a weight.
static inline LaneFloat reseed_layer(LayerKind kind, LaneMask lanes, const LayeredPixels* pixels, COLOUR_TEXELS colour,
                                     DEPTH_TEXELS depth, TexelLayout layout, const ExposedFrame* frame,
                                     const NearestSamples* nearest, LaneTexels* history, LaneFloat* alpha,
                                     LaneFloat* known) {
  LaneFloat inertia = (LaneFloat)(0.0f), between = pixels->between, from_x = nearest->from_x;
  LaneInt x = nearest->x;
  for (int i = 0; i < kLanes; ++i) {
    float4 texel = first_texel(*history);
    if (FIRST_LANE(lanes)) {
      const SeedSamples samples = {*frame, layout, FIRST_LANE(x), nearest->y, FIRST_LANE(from_x), nearest->from_y};
      const Seed seed = seed_of_layer(&samples, colour, depth, kind, FIRST_LANE(between));
      if (seed.any || kind == kNearLayer) {
        const float share = 1.0f - FIRST_LANE(*known) / CONFIDENCE_MIN;
        texel += (seed.mean - texel) * share;
#if ALPHA
        FIRST_LANE(*alpha) += (seed.alpha - FIRST_LANE(*alpha)) * share;
#endif
        FIRST_LANE(inertia) = SEED_INERTIA * share;
        FIRST_LANE(*known) = seed.any ? CONFIDENCE_MIN : 0.0f;
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

// ---- Their layers.

// Layers of one kind, and where they were.
typedef struct FetchedLayers {
  KnownLayers known;
  LayerSources from;
} FetchedLayers;

// Fetches the far layers, or the only ones, of the pixels from (x, y) on.
static inline FetchedLayers fetch_far(const LayeredPixels* pixels, const PastLayers* past, DEPTH_TEXELS depth1,
                                      TileReprojection tile, const Reprojections* motion, int x, int y) {
  const LayerWishes wishes = far_wishes_of(pixels);
  const LayerPlaces place = places_from(x, y, tile.phase_x, tile.phase_y, motion->x, motion->y);
  FetchedLayers far;
  far.from = find_sources(past, depth1, &wishes, place, tile.is_rigid);
  far.known = fetch_layers(past, depth1, &wishes, &far.from, mask_of(true));
  return far;
}

// Fetches the near ones where a pixel has two.
static inline FetchedLayers fetch_near(const LayeredPixels* pixels, const PastLayers* past, DEPTH_TEXELS depth1,
                                       LayerTile layer, int x, int y) {
  const LayerWishes wishes = near_wishes_of(pixels, layer.motion_range > CROSSING_MOTION_MIN);
  const LayerPlaces place =
      places_from(x, y, layer.phase_x, layer.phase_y, pixels->motion_x, pixels->motion_y);
  FetchedLayers near;
  near.from = find_sources(past, depth1, &wishes, place, layer.is_rigid);
  near.known = fetch_layers(past, depth1, &wishes, &near.from, pixels->is_split);
  return near;
}

// ---- Far layers.

// Returns them, and sets their alphas, as resolve_temporal fetches them. Layers answer for depth, so trust is open
// where there are or were two.
static inline FetchedHistory known_far(const LayeredPixels* pixels, const FetchedLayers* far, Reprojections* motion,
                                       LaneFloat* alpha) {
  const KnownLayers layers = far->known;
  motion->trust = select(motion->trust, pixels->open_trust, pixels->is_split | far->from.was_split);

  const LaneFloat coverage = confidences(layers.texels);
  const LaneMask is_surface = coverage > NEAR_COVERAGE_MIN;
  const LaneFloat whole = select((LaneFloat)(0.0f), 1.0f / coverage, is_surface);
  *alpha = layers.alpha * whole;
  const FetchedHistory fetched = {times(layers.texels, whole),
                                  select((LaneFloat)(0.0f), layers.confidence, is_surface),
                                  far->from.fraction_x,
                                  far->from.fraction_y};
  return fetched;
}

// Rectifies and reseeds, as correct_history. In a pixel with two layers, only reseeds the far one, with samples of it.
static inline LaneFloat correct_far(const LayeredPixels* pixels, COLOUR_TEXELS colour, DEPTH_TEXELS depth,
                                    TexelLayout layout, const ExposedFrame* frame, const SampleMotion* sample_motion,
                                    const NearestSamples* nearest, LaneTexels* history, LaneFloat* alpha,
                                    Evidence* evidence) {
  const LaneFloat inertia =
      correct_history(colour, frame, sample_motion, nearest, mask_not(pixels->is_split), history, alpha, evidence);
  const LaneMask unknown = pixels->is_split & (evidence->confidence < CONFIDENCE_MIN);
  if (!any_lane(unknown)) return inertia;
  const LaneFloat reseeded = reseed_layer(kFarLayer, unknown, pixels, colour, depth, layout, frame, nearest, history,
                                       alpha, &evidence->confidence);
  return select(inertia, reseeded, unknown);
}

// Returns 1 for samples that are added to the far, or only, layer, else 0.
static inline LaneFloat far_samples(const LayeredPixels* pixels) {
  return select((LaneFloat)(1.0f), (LaneFloat)(0.0f), pixels->is_split & mask_not(pixels->depth < pixels->between));
}

// Gives the confidences of pixels of two layers a minus sign.
static inline LaneTexels mark_split(LaneTexels texels, LaneMask is_split) {
  const LaneInt bits = as_lane_int(last_channels(texels));
  return with_last(texels, as_lane_float(select(bits, bits | INT_MIN, is_split)));
}

// ---- Near layers.

// Returns them in this frame's light, with their confidence limited. The tile's own rejection tells of the far layer
// alone; `cut`: how far the whole picture is another one.
static inline KnownLayers known_near(const LayeredPixels* pixels, const FetchedLayers* fetched, RowLight light,
                                     float cut) {
  KnownLayers near = fetched->known;
  const LaneFloat between = between_texels(fetched->from.fraction_x, fetched->from.fraction_y);
  const LaneFloat most = most_confidence(min(pixels->open_trust, 1.0f - cut));
  near.confidence = min(after_resampling(near.confidence, between), min(most, RESAMPLED_CONFIDENCE_MAX));
  const LaneFloat coverage = confidences(near.texels);
  near.texels = with_last(relight(near.texels, light), coverage);
  return near;
}

// Turns samples into what the near layers have of them, and sets their alphas. Returns their weights: 0 of those that
// are invalid or of no depth.
static inline LaneFloat near_samples(LaneTexels* samples, LaneFloat* alpha, LaneFloat depth, LaneFloat between) {
  const LaneMask is_near = depth > between, is_far = depth < between;
  const LaneFloat none = (LaneFloat)(0.0f), one = (LaneFloat)(1.0f);
  LaneFloat weight = select(none, one, is_near | is_far);
  if (may_be_bright(*samples)) weigh_by_luma(samples, &weight, kLanes);
  const LaneMask counts = is_far & (weight > none);
  weight = select(weight, one, counts);  // what is not there is not bright
  const LaneFloat coverage = select(none, one, is_near);
  *alpha = last_channels(*samples) * coverage;
  *samples = with_last(times(*samples, coverage), coverage);
  return weight;
}

// Reseeds near layers, and adds this frame's samples. `nearest`: those nearest to their pictures.
static inline KnownLayers update_near(KnownLayers near, const LayeredPixels* pixels, COLOUR_TEXELS colour,
                                      const ExposedFrame* frame, DEPTH_TEXELS depth, TexelLayout layout,
                                      const TemporalParams* params, const NearestSamples* nearest) {
#if ALPHA
  const LaneFloat coverage = confidences(near.texels);
  const LaneMask covers = pixels->is_split & (coverage > SHOWN_COVERAGE_MIN);
  const LaneFloat followed =
      coverage * follow_layer_alphas(kNearLayer, covers, pixels, colour, depth, layout, frame, nearest,
                                     near.alpha / select((LaneFloat)(1.0f), coverage, covers));
  near.alpha = select(near.alpha, followed, covers);
#endif
  LaneFloat inertia = (LaneFloat)(0.0f);
  const LaneMask unknown = pixels->is_split & (near.confidence < CONFIDENCE_MIN);
  if (any_lane(unknown))
    inertia = reseed_layer(kNearLayer, unknown, pixels, colour, depth, layout, frame, nearest, &near.texels,
                           &near.alpha, &near.confidence);

  LaneTexels samples = load_samples(colour, frame, nearest->x, nearest->y);
  const LaneFloat own = load_depth_lanes(depth, layout, nearest->x, nearest->y);
  const float reach = max(NEAR_REACH * max(params->spacing_x, params->spacing_y), WIDE_REACH);
  LaneFloat alpha;
  const LaneFloat weight =
      near_samples(&samples, &alpha, own, pixels->between) * distance_weights(params, nearest, (LaneFloat)(reach));
  const LaneFloat part = sample_parts(near.confidence, inertia, weight);
  near.texels = move_to(near.texels, samples, part);
  near.alpha += (alpha - near.alpha) * part;
  near.confidence = min(near.confidence + weight, RESAMPLED_CONFIDENCE_MAX);
  return near;
}

// Stores those of `lanes`.
static inline void store_near(STORED_HISTORY updated, int index, LaneTexels texels, LaneMask lanes) {
  for (int i = 0; i < kLanes; ++i) {
    const float4 texel = first_texel(texels);
    if (FIRST_LANE(lanes)) store_history(updated, index + i, texel);
    texels = push_texel(texels, texel);
    lanes = NEXT_LANES(lanes);
  }
}
