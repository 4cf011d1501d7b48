// SPDX-License-Identifier: MIT
// resolve_layers: does the work of resolve_temporal in tiles where pixels may have two layers. A pixel has the layers
// of the sample nearest to its picture.
//   One layer: as in resolve_temporal, but of texels of two layers it takes the one of its own depth.
//   The far layer: the same, with samples of the far surface only. It is not rectified.
//   The near layer: follows the near surface; a sample of the far one counts as one of no colour and no coverage, one
//   of the near one covers wholly, whatever its alpha.
//
//   params             in   as in resolve_temporal
//   before             in   the previous frame's samples
//   depth_layout       in   of this frame's depth
//   positions          in   as in resolve_temporal
//   colour             in   RGBA16F or RGBA32F, viewport, linear, premultiplied
//   reprojection       in   Reprojection of each sample, of split ones the far layer's
//   depth, depth1      in   R32F, viewports of both frames
//   open_trust         in   of each sample; its sign does not matter
//   splits             in   LayerSplit of each split sample
//   history            in   the far layer of the previous frame
//   alpha              in   ALPHA 1: its alpha
//   near_history       in   the near layer of the previous frame, in the same format
//   states             in   LayerState of each texel of the previous frame, with the near layer's alpha
//   previous_tiles     in   TileReprojection of each tile, of the previous frame
//   previous_layers    in   LayerTile of each tile, of the previous frame
//   tiles, layers      in   the same of this frame
//   light              in   TileLight of each tile, of this frame
//   listed             in   the tiles that are layered, in any order
//   total              in   TotalLight: how many those are
//   updated            out  the far layer of this frame
//   updated_alpha      out  ALPHA 1: its alpha
//   updated_near       out  its near layer
//   updated_states     out  LayerState of each texel of a layered tile
//   non_finite         out  non_finite[params.counter] grows by the pixels whose sample is NaN or infinite
//   exposure           in   Exposure of this frame
// Options: ALPHA  0 (default) | 1: alpha is accumulated, in both layers as colour is
//          SOURCE_STORAGE, SOURCE_FORMAT, HISTORY_FORMAT as of resolve_temporal
// Reference: tests/reference/resolve_layers.cpp
#ifndef ALPHA
#define ALPHA 0
#endif
#if ALPHA < 0 || ALPHA > 1
#error "ALPHA must be 0 or 1"
#endif

#include "layers/tile_runs.h"
#include "layers/update_layers.h"

__kernel void resolve_layers(const TemporalParams params, const HistorySamples before, const TexelLayout depth_layout,
                             __global const int* positions, COLOUR_TEXELS colour, __global const float* reprojection,
                             DEPTH_TEXELS depth, DEPTH_TEXELS depth1, __global const float* open_trust,
                             __global const LayerSplit* splits, HISTORY_TEXELS history, HISTORY_TEXELS alpha,
                             HISTORY_TEXELS near_history, __global const half* states,
                             __global const TileReprojection* previous_tiles, __global const LayerTile* previous_layers,
                             __global const TileReprojection* tiles, __global const LayerTile* layers,
                             __global const TileLight* light, __global const int* listed,
                             __global const TotalLight* total, STORED_HISTORY updated, STORED_HISTORY updated_alpha,
                             STORED_HISTORY updated_near, __global half* updated_states, __global uint* non_finite,
                             __global const Exposure* exposure) {
  const ItemRuns runs = runs_of_item(total->layered);
  const ExposedFrame frame = expose(params.frame0, exposure);
  const PastLayers past = past_layers(params.output_width, params.output_height, before, history, alpha, near_history,
                                      states, previous_tiles, previous_layers);
  const SampleMotion sample_motion = {reprojection, params.reprojection, params.motion_x, params.motion_y};
  uint met_count = 0;
  for (int run = runs.first; run < runs.end; run += runs.step) {
    const int tile_index = listed[run / kRunsOfTile];
    const int2 pixel = pixel_of_run(run, tile_index, params.tiles_x);
    const int x = pixel.x, y = pixel.y, count = min(params.output_width - x, (int)kLanes);
    if (count < 1 || y >= params.output_height) continue;
    const LayerTile layer = layers[tile_index];
    const Positions row = row_position(&params, positions, y);
    TileReprojection tile = tiles[tile_index];

    // The far layers, or the only ones.
    const NearestSamples nearest = find_nearest_samples(&params, positions, x, row, tile);
    will_read_samples(&params, colour, reprojection, depth, depth_layout, open_trust, splits, &nearest);
    Reprojections motion = load_reprojections(&params, reprojection, &nearest);
    const LayeredPixels pixels =
        find_layers(depth, depth_layout, &params, splits, open_trust, &nearest, motion.is_split);
    const FetchedLayers far = fetch_far(&pixels, &past, depth1, tile, &motion, x, y);
    LaneFloat known_alpha;
    const FetchedHistory fetched = known_far(&pixels, &far, &motion, &known_alpha);
    Evidence evidence = limit_confidence(&fetched, &motion);
    const RowLight row_light = light_of_row(light, &params, exposure->change, x, y);
    reject_by_light(&evidence, row_light);
    evidence.rejection = select(evidence.rejection, (LaneFloat)(0.0f), pixels.is_split);
    LaneTexels known = relight(fetched.texels, row_light);
    LaneTexels samples = load_samples(colour, &frame, nearest.x, nearest.y);
#if ALPHA
    // What nothing is known of, and no sample shows, is as transparent as what hides it.
    const LaneTexels held = held_samples(samples);
    known_alpha = select(known_alpha, last_channels(held), are_valid(held) & (fetched.confidence == 0.0f));
    const LayerSources* from = &far.from;
    const Positions from_x = {from->x, from->fraction_x}, from_y = {from->y, from->fraction_y};
    known_alpha = follow_alphas(colour, &frame, past.far, past.alpha, nearest_texels(from_x), nearest_texels(from_y),
                                nearest.x, nearest.y, known_alpha, mask_not(pixels.is_split));
    known_alpha = follow_layer_alphas(kFarLayer, pixels.is_split, &pixels, colour, depth, depth_layout, &frame,
                                      &nearest, known_alpha);
#endif
    LaneFloat taken = far_samples(&pixels);
    if (light[tile_index].holds_back)
      taken = select(taken, (LaneFloat)(0.0f), are_held_back(known, evidence.confidence, samples));
    LaneFloat inertia = (LaneFloat)(0.0f);
    if (needs_correction(&evidence))
      inertia = correct_far(&pixels, colour, depth, depth_layout, &frame, &sample_motion, &nearest, &known,
                            &known_alpha, &evidence);
    if (layer.is_split) tile.is_rigid = 0;  // it does not move as a whole
    LaneFloat weight = distance_weights(&params, &nearest, reach_of(tile, evidence.confidence)) * taken;
    if (may_be_bright(samples)) met_count += weigh_by_luma(&samples, &weight, count);
    const LaneTexels sum = accumulate(known, evidence.confidence, inertia, samples, weight);
    const int index = y * params.output_width + x;
    store_history_lanes(updated, index, count, mark_split(sum, pixels.is_split));
#if ALPHA
    store_alpha_lanes(updated_alpha, index, count,
                 accumulate_alpha(known_alpha, evidence.confidence, inertia, samples, weight));
#endif

    // The near layers.
    const LaneFloat zero = (LaneFloat)(0.0f);
    if (!any_lane(pixels.is_split)) {
      store_states(updated_states, index, count, pixels.depth, zero, zero, zero);
      continue;
    }
    TileReprojection near_tile = {.is_rigid = layer.is_rigid};
    near_tile.phase_x = layer.phase_x;
    near_tile.phase_y = layer.phase_y;
    const NearestSamples nearest_near = find_nearest_samples(&params, positions, x, row, near_tile);
    const float cut = light[tile_index].new_cut;
    const FetchedLayers fetched_near = fetch_near(&pixels, &past, depth1, layer, x, y);
    KnownLayers near = known_near(&pixels, &fetched_near, row_light, cut);
    near = update_near(near, &pixels, colour, &frame, depth, depth_layout, &params, &nearest_near);
    const LaneMask is_inside = LANE_NUMBERS < count;
    store_near(updated_near, index, near.texels, pixels.is_split & is_inside);
    store_states(updated_states, index, count, select(pixels.depth, pixels.far_depth, pixels.is_split),
                 select(zero, pixels.near_depth, pixels.is_split), select(zero, near.confidence, pixels.is_split),
                 select(zero, ALPHA ? near.alpha : zero, pixels.is_split));
  }
  if (met_count > 0) atomic_add(non_finite + params.counter, met_count);
}
