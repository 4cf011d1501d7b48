// SPDX-License-Identifier: MIT
// Adds this frame's samples to the layers of eight pixels of a row.
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

// ---- Their layers.

// Layers of one kind, and where they were.
typedef struct FetchedLayers {
  KnownLayers known;
  LayerSources from;
} FetchedLayers;

typedef struct BothLayers {
  FetchedLayers far, near;  // far or only ones; the near ones only where a pixel has two
} BothLayers;

// Fetches the layers of the pixels from (x, y) on. Unrolled: a real loop would carry all eight
// lanes as live values from one round to the next.
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
