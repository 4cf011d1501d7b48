// SPDX-License-Identifier: MIT
// resize_layers: resizes the near layer and the states of the history to another output. Runs after resize_history and
// resize_tiles, in layered tiles only.
//   The state of a pixel is that of the texel nearest to its centre, stored or not; the near layer's confidence is
//   scaled and limited as the far one's in resize_history. If that texel has two layers, the near one is read as
//   resize_history reads the far one, among texels whose near layer is in front of the depth half-way between that
//   texel's layers.
//
//   params             in   extents, places
//   before             in   the samples of the history's frame
//   positions          in   as in resize_history
//   depth              in   R32F, of the history's frame
//   previous_tiles     in   TileReprojection of each tile of the history
//   previous_layers    in   LayerTile of each
//   history            in   the far layer
//   alpha              in   ALPHA 1: its alpha
//   near_history       in   the near layer
//   states             in   LayerState of each texel of a layered tile
//   layers             in   LayerTile of each of the output's tiles
//   resized_near       out  the near layer of pixels that have two
//   resized_states     out  LayerState of each pixel of a layered tile
// Options: ALPHA, SOURCE_STORAGE, HISTORY_FORMAT as of resolve_layers
// Reference: tests/reference/resize_history.cpp
#ifndef ALPHA
#define ALPHA 0
#endif
#if ALPHA < 0 || ALPHA > 1
#error "ALPHA must be 0 or 1"
#endif
#include "arithmetic.h"
#include "layers/past_layers.h"
#include "temporal/constants.h"
#include "temporal/resized_pixels.h"

// The states of the texels nearest to pixels.
typedef struct NearestTexels {
  float far_depth[kLanes], near_depth[kLanes], near_confidence[kLanes];
  bool is_split[kLanes];
} NearestTexels;

// Sets the pixels' phases to those of the near layer.
static inline NearestTexels look_at_nearest(const ResizeParams* params, const PastLayers* past, DEPTH_TEXELS depth,
                                            ResizedPixels* pixels) {
  NearestTexels nearest;
  int texel[kLanes];
  float phase_x[kLanes], phase_y[kLanes];
  STORE_LANES(pixels->x, texel);
  for (int i = 0; i < kLanes; ++i) {
    const LayerState state = state_at(past, depth, texel[i], pixels->y);
    const float2 phase = phase_of(past, previous_tile(params, texel[i], pixels->y), kNearLayer);
    nearest.far_depth[i] = state.far_depth;
    nearest.near_depth[i] = state.near_depth;
    nearest.near_confidence[i] = min(state.near_confidence * params->share, params->most);
    nearest.is_split[i] = as_int(load_confidence(past->far, pixels->y * past->far.width + texel[i])) < 0;
    phase_x[i] = phase.x;
    phase_y[i] = phase.y;
  }
  pixels->phase_x = LOAD_LANES(phase_x);
  pixels->phase_y = LOAD_LANES(phase_y);
  return nearest;
}

// Resamples the near layer at one of a pixel's places, among the 4x4 texels from (x, y) on.
static inline float4 near_at(const PastLayers* past, DEPTH_TEXELS depth, float between, int x, int y, float4 wx,
                             float4 wy) {
  return sample_neighbourhood(load_near_texels(past, depth, between, window_at(past, x, y, 4)), wx, wy);
}

// Adds `part` of the near layer, and of its alpha, at one place of each of the first `count` pixels that has two.
static inline void add_near(const PastLayers* past, DEPTH_TEXELS depth, const NearestTexels* nearest,
                            SourcePlaces from, int count, float part, float4* sums, float* alphas) {
  LaneInt x = from.x.texel, y = from.y.texel;
  Cubic wx = cubic_weights(from.x.fraction, HISTORY_SHARPNESS), wy = cubic_weights(from.y.fraction, HISTORY_SHARPNESS);
  for (int i = 0; i < count; ++i) {
    if (nearest->is_split[i]) {
      const float between = 0.5f * (nearest->far_depth[i] + nearest->near_depth[i]);
      const float4 x_weights = first_weights(wx), y_weights = first_weights(wy);
      sums[i] += near_at(past, depth, between, FIRST_LANE(x), FIRST_LANE(y), x_weights, y_weights) * part;
#if ALPHA
      alphas[i] +=
          sample_near_alpha(past, depth, between, FIRST_LANE(x), FIRST_LANE(y), x_weights, y_weights) * part;
#endif
    }
    x = NEXT_LANES(x);
    y = NEXT_LANES(y);
    wx = next_weights(wx);
    wy = next_weights(wy);
  }
}

__kernel void resize_layers(const ResizeParams params, const HistorySamples before, __global const int* positions,
                            DEPTH_TEXELS depth, __global const TileReprojection* previous_tiles,
                            __global const LayerTile* previous_layers, HISTORY_TEXELS history,
                            HISTORY_TEXELS alpha, HISTORY_TEXELS near_history, __global const half* states,
                            __global const LayerTile* layers, STORED_HISTORY resized_near,
                            __global half* resized_states) {
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(params.columns_per_item, params.width, kLanes);
  if (item.first >= item.end || y >= params.height) return;

  const Positions row = row_among_texels(&params, positions, y);
  const int places = params.places_x * params.places_y;
  const PastLayers past = past_layers(params.previous_width, params.previous_height, before, history, alpha,
                                      near_history, states, previous_tiles, previous_layers);
  for (int x = item.first; x < item.end; x += item.step) {
    if (!layers[y / kTemporalTile * params.tiles_x + x / kTemporalTile].is_layered) continue;
    const int count = min(pixels_from(item, x), (int)kLanes);
    ResizedPixels pixels = pixels_among_texels(&params, positions, x, row);
    const NearestTexels nearest = look_at_nearest(&params, &past, depth, &pixels);
    float4 sums[kLanes];
    float alphas[kLanes];
    for (int i = 0; i < kLanes; ++i) {
      sums[i] = (float4)(0.0f);
      alphas[i] = 0.0f;
    }
    for (int place = 0; place < places; ++place) {
      const SourcePlaces from =
          places_among_texels(&params, &pixels, place % params.places_x, place / params.places_x);
      add_near(&past, depth, &nearest, from, count, 1.0f / (float)places, sums, alphas);
    }
    store_states(resized_states, y * params.width + x, count, LOAD_LANES(nearest.far_depth),
                 LOAD_LANES(nearest.near_depth), LOAD_LANES(nearest.near_confidence), LOAD_LANES(alphas));
    for (int i = 0; i < count; ++i) {
      if (nearest.is_split[i]) store_history(resized_near, y * params.width + x + i, sums[i]);
    }
  }
}
