// SPDX-License-Identifier: MIT
// resolve_temporal: adds this frame's samples to a history of the output's size, which follows the surfaces.
//   m  history's colour where the pixel's picture was in the previous frame: a texel's own in a rigid tile, else a
//      cubic, clamped to the range of the middle texels
//   W  its confidence, the sum of the weights of the samples in it: at most 32, or 8 once resampled, less what
//      resampling, disocclusion, reactive values, motion edges and a change of light take
//   m += (s - m) w / (W + w)
//   s  the nearest sample; d its distance from the pixel's picture, output pixels
//   w  its weight, (1 - d^2 / r^2)^2 / max(1, brightest channel of s / 2);
//      r = .98, in still tiles down to .82 as W grows; 1.05 in tiles that are not rigid
// In a tile that holds back (TileLight), outliers of pixels whose history is known do not count.
// History is brought into the range of the samples only where there is evidence against it: done everywhere, that loses
// more than it saves. Where W is less than .15 history is reseeded with a Gaussian of this frame's samples.
//
//   params          in   extents, layouts, distances
//   positions       in   of each output column, then row, in the viewport, as in resolve_reprojected
//   colour          in   RGBA16F or RGBA32F, viewport, linear, premultiplied
//   reprojection    in   MOTION 1: Reprojection of each sample, from reproject with MOTION_EDGE 1
//   reactive0, 1    in   REACTIVE 1: R8 of both frames, viewports
//   history         in   the layer of the previous frame; all zero where there is none
//   alpha           in   ALPHA 1: its alpha, a plane of its own; all zero where there is none
//   previous_tiles  in   TileReprojection of each tile, of the previous frame
//   tiles           in   the same of this frame
//   light           in   TileLight of each tile, of this frame
//   layers          in   LAYERS 1: LayerTile of each tile, of this frame
//   updated         out  the layer of this frame
//   updated_alpha   out  ALPHA 1: its alpha
//   view            out  VIEW other than PICTURE: RGBA32F or RGBA16F, output extent
//   non_finite      out  non_finite[params.counter] grows by the pixels whose sample is NaN or infinite
//   exposure        in   Exposure of this frame
// Options: ALPHA     0 (default) | 1: alpha is accumulated as colour is, with the same weights
//          MOTION    1 (default) | 0: nothing moves
//          REACTIVE  0 (default) | 1: with MOTION 0; else the reprojection's trust holds what reactive values take
//          TAPS      16 (default) | 4: history is resampled bilinearly, which is cheaper and blurs | 36: from 6x6
//                    texels, which is dearer and sharper
//          LAYERS    0 (default) | 1: leaves layered tiles to resolve_layers
//          VIEW      PICTURE (default): temporal_display makes the picture
//                    CONFIDENCE  grey: confidence over the most there is
//                    REJECTION   red: 1 - trust, green: rejection by a motion edge, blue: rejection by temporal_light
//                    PHASE       red x, green y: where between texels history lies; blue: 1 in a rigid tile, whose
//                                phase it is, 0 where history was resampled
//          SOURCE_STORAGE, SOURCE_FORMAT, OUTPUT_FORMAT (of a view) as in texel.h
//          HISTORY_FORMAT as in temporal/history.h
// Reference: tests/reference/resolve_temporal.cpp
#ifndef ALPHA
#define ALPHA 0
#endif
#if ALPHA < 0 || ALPHA > 1
#error "ALPHA must be 0 or 1"
#endif

#include "bits.h"
#include "layers/layer.h"
#include "temporal/accumulate.h"
#include "temporal/constants.h"
#include "temporal/fetch_history.h"
#include "temporal/frame_samples.h"
#include "temporal/limit_confidence.h"
#include "temporal/reprojection.h"
#include "temporal/reseed.h"
#include "temporal/tile_path.h"
#include "texel.h"

#ifndef LAYERS
#define LAYERS 0
#endif
#if LAYERS < 0 || LAYERS > 1
#error "LAYERS must be 0 or 1"
#endif

#define PICTURE 1
#define CONFIDENCE 2
#define REJECTION 3
#define PHASE 4
#ifndef VIEW
#define VIEW PICTURE
#endif
#if VIEW != PICTURE && VIEW != CONFIDENCE && VIEW != REJECTION && VIEW != PHASE
#error "VIEW must be PICTURE, CONFIDENCE, REJECTION or PHASE"
#endif

#if VIEW != PICTURE
// A view of pixels of a row.
typedef struct View {
  LaneFloat red, green, blue;
} View;

#if VIEW == CONFIDENCE
static inline View view_confidence(LaneTexels updated) {
  const LaneFloat part = confidences(updated) * (1.0f / CONFIDENCE_MAX);
  const View view = {part, part, part};
  return view;
}
#elif VIEW == REJECTION
static inline View view_rejection(const Reprojections* motion, RowLight light) {
  const View view = {1.0f - motion->trust, edge_rejection(motion->motion_edge), ramp_cells(light)};
  return view;
}
#else
static inline View view_phase(TileReprojection tile, const FetchedHistory* history) {
  View view;
  view.red = tile.is_rigid ? (LaneFloat)(tile.phase_x + 0.5f) : history->fraction_x;
  view.green = tile.is_rigid ? (LaneFloat)(tile.phase_y + 0.5f) : history->fraction_y;
  view.blue = (LaneFloat)(tile.is_rigid ? 1.0f : 0.0f);
  return view;
}
#endif

// Stores the first `count` of the pixels from (x, y) on.
static inline void store_view(OUTPUT_TEXELS output, TexelLayout layout, int x, int y, int count, View view) {
  for (int i = 0; i < min(count, (int)kLanes); ++i) {
    store_output(output, layout, x + i, y,
                 (float4)(FIRST_LANE(view.red), FIRST_LANE(view.green), FIRST_LANE(view.blue), 1.0f));
    view.red = NEXT_LANES(view.red);
    view.green = NEXT_LANES(view.green);
    view.blue = NEXT_LANES(view.blue);
  }
}
#endif

// Whether a row may take the path kCopiedPlain, which knows neither alpha nor a view.
#if ALPHA || VIEW != PICTURE
#define MAY_BE_PLAIN false
#else
#define MAY_BE_PLAIN true
#endif

enum { kPlainAhead = 6 * kTemporalTile, kColourAhead = 24 };  // texels and samples to prefetch

// Adds samples to pixels on the path kCopiedPlain, from (x, y) on. Returns false, and stores nothing, where too
// little is known of one, or a sample is bright or not finite.
static inline bool resolve_plain_row(const TemporalParams* params, COLOUR_TEXELS colour, const ExposedFrame* frame,
                                     HistoryLayer layer, TileReprojection tile, const NearestSamples* nearest,
                                     STORED_HISTORY updated, int x, int y) {
  const int index = y * params->output_width + x;
  const int from = index - tile.step_y * params->output_width - tile.step_x;
  will_read_history(layer, from + kPlainAhead);
  WILL_WRITE(updated + 4 * (index + kPlainAhead));
  const FetchedHistory fetched = copy_history(layer, x - tile.step_x, y - tile.step_y);
  const LaneTexels samples = load_samples(colour, frame, nearest->x, nearest->y);
  if (any_lane(fetched.confidence < CONFIDENCE_MIN) || may_be_bright(samples)) return false;
  const LaneFloat weight = distance_weights(params, nearest, reach_of(tile, fetched.confidence));
  const LaneTexels sum = accumulate(fetched.texels, fetched.confidence, (LaneFloat)(0.0f), samples, weight);
  store_history_lanes(updated, index, kLanes, sum);
  return true;
}

__kernel void resolve_temporal(const TemporalParams params, __global const int* positions, COLOUR_TEXELS colour,
                               __global const float* reprojection, REACTIVE_TEXELS reactive0, REACTIVE_TEXELS reactive1,
                               HISTORY_TEXELS history, HISTORY_TEXELS alpha,
                               __global const TileReprojection* previous_tiles, __global const TileReprojection* tiles,
                               __global const TileLight* light, __global const LayerTile* layers,
                               STORED_HISTORY updated, STORED_HISTORY updated_alpha, OUTPUT_TEXELS view,
                               __global uint* non_finite, __global const Exposure* exposure) {
  const int first_y = get_global_id(1) * kTemporalTile;
  const ItemColumns item = columns_of_item(params.columns_per_item, params.output_width, kLanes);
  if (item.first >= item.end || first_y >= params.output_height) return;

  const int end_y = min(first_y + kTemporalTile, params.output_height);
  const ExposedFrame frame = expose(params.frame0, exposure);
  const float change = exposure->change;
  const HistoryLayer layer = {history, params.output_width, params.output_height};
  const SampleMotion sample_motion = {reprojection, params.reprojection, params.motion_x, params.motion_y};
  const int tile_y = first_y / kTemporalTile;
  bool left_is_even = has_even_light(light, &params, item.first / kTemporalTile - 1, tile_y);
  bool own_is_even = has_even_light(light, &params, item.first / kTemporalTile, tile_y);
  uint met_count = 0;
  for (int x = item.first; x < item.end; x += item.step) {
    const int count = pixels_from(item, x);
    const int tile_x = x / kTemporalTile;
    const int tile_index = tile_y * params.tiles_x + tile_x;
    const TileReprojection tile = tiles[tile_index];
    const bool right_is_even = has_even_light(light, &params, tile_x + 1, tile_y);
    if (kLanes == 1) left_is_even = has_even_light(light, &params, tile_x - 1, tile_y);
    if (kLanes == 1) own_is_even = has_even_light(light, &params, tile_x, tile_y);
    const bool even = left_is_even && own_is_even && right_is_even && change == 1.0f;
    left_is_even = own_is_even;
    own_is_even = right_is_even;
#if LAYERS
    if (layers[tile_index].is_layered) continue;
#endif
    const NearestSamples columns = find_nearest_columns(&params, positions, x, tile);
    const bool holds_back = light[tile_index].holds_back;
    const TileRows rows =
        tile_rows(previous_tiles, &params, tile, MAY_BE_PLAIN && even && !holds_back, tile_x, first_y, end_y - 1);
    for (int y = first_y; y < end_y; ++y) {
      // Reproject.
      const NearestSamples nearest = in_row(&params, columns, row_position(&params, positions, y), tile);
      will_read_colour(colour, frame.colour, FIRST_LANE(nearest.x) + kColourAhead, nearest.y);
      const TilePath path =
          path_of_row(rows, previous_tiles, &params, reactive0, reactive1, &nearest, tile, tile_x, y);
      if (path == kCopiedPlain && resolve_plain_row(&params, colour, &frame, layer, tile, &nearest, updated, x, y))
        continue;
      const bool looks_up_motion = path == kResampled || path == kCopied;
      Reprojections motion = no_motion();
      if (looks_up_motion) motion = reproject_pixels(&params, reprojection, reactive0, reactive1, &nearest);

      // Fetch history, and limit its confidence.
      const FetchedHistory fetched = fetch_history(layer, previous_tiles, &params, tile, path, &motion, x, y);
      Evidence evidence = full_evidence(&fetched);
      if (looks_up_motion) evidence = limit_confidence(&fetched, &motion);
      LaneFloat known_alpha = (LaneFloat)(1.0f);
#if ALPHA
      const AlphaPlane plane = {alpha, params.output_width, params.output_height};
      known_alpha = fetch_alpha(plane, previous_tiles, &params, tile, path, &motion, x, y);
#endif

      // Relight.
      const RowLight row_light = even ? even_light() : light_of_row(light, &params, change, x, y);
      reject_by_light(&evidence, row_light);
      LaneTexels known = relight(fetched.texels, row_light);

      // Load the samples, and find outliers to hold back.
      LaneTexels samples = load_samples(colour, &frame, nearest.x, nearest.y);
#if ALPHA
      const LaneMask differs = mask_not(are_valid(held_samples(samples)) & (last_channels(samples) == known_alpha));
      if (any_lane(differs)) {
        LaneInt from_x = x - tile.step_x + LANE_NUMBERS, from_y = (LaneInt)(y - tile.step_y);
        if (path == kResampled) {
          const SourcePlaces from = source_places(previous_tiles, &params, tile, &motion, x, y);
          from_x = nearest_texels(from.x);
          from_y = nearest_texels(from.y);
        }
        known_alpha = follow_alphas(colour, &frame, layer, plane, from_x, from_y, nearest.x, nearest.y, known_alpha,
                                    differs);
      }
#endif
      LaneMask held = mask_of(false);
      if (holds_back) held = are_held_back(known, evidence.confidence, samples);

      // Rectify and reseed.
      LaneFloat inertia = (LaneFloat)(0.0f);
      if (needs_correction(&evidence))
        inertia =
            correct_history(colour, &frame, &sample_motion, &nearest, mask_of(true), &known, &known_alpha, &evidence);

      // Accumulate.
      LaneFloat weight = distance_weights(&params, &nearest, reach_of(tile, evidence.confidence));
      if (holds_back) weight = select(weight, (LaneFloat)(0.0f), held);
      if (may_be_bright(samples)) met_count += weigh_by_luma(&samples, &weight, count);
      const LaneTexels sum = accumulate(known, evidence.confidence, inertia, samples, weight);

      // Store.
      store_history_lanes(updated, y * params.output_width + x, count, sum);
#if ALPHA
      store_alpha_lanes(updated_alpha, y * params.output_width + x, count,
                   accumulate_alpha(known_alpha, evidence.confidence, inertia, samples, weight));
#endif
#if VIEW == CONFIDENCE
      store_view(view, params.output, x, y, count, view_confidence(sum));
#elif VIEW == REJECTION
      store_view(view, params.output, x, y, count, view_rejection(&motion, row_light));
#elif VIEW == PHASE
      store_view(view, params.output, x, y, count, view_phase(tile, &fetched));
#endif
    }
  }
  if (met_count > 0) atomic_add(non_finite + params.counter, met_count);
}
