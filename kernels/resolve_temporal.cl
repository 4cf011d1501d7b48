// SPDX-License-Identifier: MIT
// resolve_temporal: adds this frame's samples to a history of the output's size, which follows the surfaces.
//   m  history's colour where the pixel's picture was: a texel's own in a rigid tile, else a cubic, held in the range of the
//      middle four texels
//   W  its confidence, the weights of all samples in it: at most 32, or 8 once resampled, less what resampling, uncovering,
//      reactive values and edges of motion take
//   m += (s - m) w / (W + w)  with the nearest sample s, w = (1 - d^2 / r^2)^2 / max(1, brightness / 2), d its distance in output
//      pixels, r = 1.05, in still tiles down to .85 as W grows
// Where history is doubtful it is brought into the range of the samples there; nowhere else, for that costs more than it
// saves. What is hardly known begins with a Gaussian of this frame, which its first sample moves little.
//
//   params       in   extents, layouts, distances
//   positions    in   of each output column, then row, in the viewport, as in resolve_reprojected
//   colour       in   RGBA16F or RGBA32F, viewport, linear, premultiplied
//   moves        in   MOTION 1: of each sample, from reproject with CONTRAST 1
//   reactive0, 1 in   REACTIVE 1: R8 of both frames
//   history      in   of the previous frame; all zero where there is none
//   previous     in   TemporalTile of each tile, of the previous frame
//   tiles        in   the same of this frame
//   updated      out  history of this frame
//   output       out  params.view not kViewPicture: what is known of each pixel, RGBA32F or RGBA16F, output extent
//   non_finite   out  non_finite[params.counter] grows by the pixels whose sample is NaN or infinite and counts for nothing
// Options: MOTION    1 (default) | 0: nothing moves
//          REACTIVE  0 (default) | 1: with MOTION 0; else the moves hold what they take
//          TAPS      16 (default) | 4: history is read bilinearly, which is cheaper and blurs
//          TRUST     NEAREST (default) | BILINEAR: between samples
//          SOURCE_STORAGE, SOURCE_FORMAT as in texel.h, HISTORY_FORMAT as in history.h
// Reference: tests/reference/resolve_temporal.cpp
#include "texel.h"

#include "begin_history.h"
#include "distance_weights.h"
#include "eight_samples.h"
#include "history_sampling.h"
#include "temporal_evidence.h"
#include "temporal_view.h"

#define INERTIA 0.85f      // of a whole Gaussian
#define REACH 1.05f        // output pixels
#define LEAST_REACH 0.85f
#define NARROWING 0.1f     // output pixels for each unit of confidence

// Eight pixels to go through one by one, which is slow and seldom needed.
typedef struct EightPixels {
  float4 history[8];
  float confidence[8], doubt[8], offset_x[8];
  float inertia[8];  // that of what began anew, against this frame's sample
  int x[8];
} EightPixels;

// Brings doubtful history into the range of its surroundings, and begins anew what is hardly known.
static inline void correct_history(COLOUR_TEXELS colour, const SourceFrame* frame, const Surfaces* surfaces, EightPixels* pixels, int y, float offset_y) {
  for (int i = 0; i < 8; ++i) {
    float4 m = pixels->history[i];
    float w = pixels->confidence[i];
    pixels->inertia[i] = 0.0f;
    if (pixels->doubt[i] > 0.0f) {
      const ToneBox box = tone_box(colour, frame, pixels->x[i], y);
      m = rectify(m, w, pixels->doubt[i], &box);
      w = m.w;
    }
    if (w < LEAST_CONFIDENCE) {
      const float4 smooth = smooth_samples(colour, frame, surfaces, pixels->x[i], y, pixels->offset_x[i], offset_y);
      m += (smooth - m) * (1.0f - w / LEAST_CONFIDENCE);
      pixels->inertia[i] = INERTIA * (1.0f - w / LEAST_CONFIDENCE);
      w = smooth.w > 0.0f ? LEAST_CONFIDENCE : 0.0f;
    }
    pixels->history[i] = m;
    pixels->confidence[i] = w;
  }
}

#define EIGHT(step) step(s0, 0); step(s1, 1); step(s2, 2); step(s3, 3); step(s4, 4); step(s5, 5); step(s6, 6); step(s7, 7)

#define RESAMPLE(i, n)                                                                                                  \
  const float4 m##n =                                                                                                   \
      sample_history(history, params.output_width, params.output_height, from_x.texel.i, from_y.texel.i, inside,        \
                     (float4)(wx.w0.i, wx.w1.i, wx.w2.i, wx.w3.i), (float4)(wy.w0.i, wy.w1.i, wy.w2.i, wy.w3.i))

#define LOAD(i, n) const float4 s##n = load_colour(colour, frame0.colour, nearest_x.i, nearest_y)

#define SHOW(i, n) \
  if (x + n < end) store_view(output, &params, x + n, y, (float4)(shown.red.i, shown.green.i, shown.blue.i, 1.0f))

__kernel void resolve_temporal(const TemporalParams params, __global const int* positions, COLOUR_TEXELS colour,
                               __global const float* moves, REACTIVE_TEXELS reactive0, REACTIVE_TEXELS reactive1,
                               HISTORY_TEXELS history, __global const TemporalTile* previous,
                               __global const TemporalTile* tiles, STORED_HISTORY updated, __global float* output,
                               __global uint* non_finite) {
  const int y = get_global_id(1);
  const int first = get_global_id(0) * params.columns_per_item;
  if (first >= params.output_width || y >= params.output_height) return;

  const int end = min(first + params.columns_per_item, params.output_width);
  const SourceFrame frame0 = params.frame0;
  const int row_texel = positions[2 * params.columns + y];
  const float row_fraction = as_float(positions[2 * params.columns + params.output_height + y]);
  const Positions row = {(int8)(row_texel), (float8)(row_fraction)};
  uint met_count = 0;
  float2 change1 = change_at(tiles, &params, first, y);
  for (int x = first; x < end; x += kTemporalTile) {
    const TemporalTile tile = tiles[y / kTemporalTile * params.tiles_x + x / kTemporalTile];
    const Positions column = {vload8(0, positions + x), as_float8(vload8(0, positions + params.columns + x))};
    const Positions place_x = shifted_positions(column, (float8)(tile.offset_x / params.spacing_x));
    const Positions place_y = shifted_positions(row, (float8)(tile.offset_y / params.spacing_y));
    const Positions now_x = held_positions(place_x, frame0.width - 1), now_y = held_positions(place_y, frame0.height - 1);
    const int8 nearest_x = nearest_samples(now_x);
    const int nearest_y = nearest_samples(now_y).s0;
    // From the samples, which may be far from what lies beyond the outermost.
    const float8 samples_x = place_x.fraction + convert_float8(place_x.texel - nearest_x);
    const float samples_y = place_y.fraction.s0 + (float)(place_y.texel.s0 - nearest_y);

    const int source_x = x - tile.step_x, source_y = y - tile.step_y;
    const bool copies = may_copy(previous, &params, tile, source_x, source_y);
    Motion motion = {(float8)(0.0f), (float8)(0.0f), (float8)(1.0f), (float8)(0.0f)};
#if MOTION
    const bool plain = copies && tile.plain;
    if (!plain) motion = motion_of(&params, moves, now_x, now_y, nearest_x, nearest_y);
#elif REACTIVE
    const bool plain = false;
    motion.trust = trust_of_still(&params, reactive0, reactive1, nearest_x, nearest_y);
#else
    const bool plain = copies;
#endif
    EightTexels m;
    int8 lost = (int8)(0);
    Positions from_x = {(int8)(source_x), (float8)(0.0f)}, from_y = {(int8)(source_y), (float8)(0.0f)};
    if (copies) {
      m = load_history8(history, source_y * params.output_width + source_x);
    } else {
      source_places(previous, &params, tile, &motion, x, y, &from_x, &from_y);
      const Cubic wx = cubic_weights(from_x.fraction, HISTORY_SHARPNESS), wy = cubic_weights(from_y.fraction, HISTORY_SHARPNESS);
      const bool inside = lie_inside(from_x.texel, from_y.texel, params.output_width, params.output_height);
      will_read_rows(history, params.output_width, from_x.texel.s0 + kResampledAhead, from_y.texel.s0);
      EIGHT(RESAMPLE);
      m.left = (float16)(m0, m1, m2, m3);
      m.right = (float16)(m4, m5, m6, m7);
      if (!inside) lost = lie_outside(from_x, params.output_width) | lie_outside(from_y, params.output_height);
    }
    const float8 known = select(clamp(confidences(m), 0.0f, MOST_CONFIDENCE), (float8)(0.0f), lost);
    Evidence evidence = {known, (float8)(0.0f)};
    if (!plain) evidence = weigh_history(known, from_x.fraction, from_y.fraction, &motion);
    const float2 change0 = change1;
    change1 = change_at(tiles, &params, x + kTemporalTile, y);
    const float8 changed = ramp(change0.x, change1.x);
    if (change0.x + change1.x > 0.0f) {
      evidence.doubt = max(evidence.doubt, changed);
      evidence.confidence = min(evidence.confidence, most_confidence(1.0f - changed));
    }
    if (change0.y != 1.0f || change1.y != 1.0f) {
      const float8 gain = ramp(change0.y, change1.y);
      m.left *= to_four_texels(gain.lo);
      m.right *= to_four_texels(gain.hi);
    }
    float8 inertia = (float8)(0.0f);
    if (any_lane((evidence.doubt > 0.0f) | (evidence.confidence < LEAST_CONFIDENCE))) {
      EightPixels pixels;
      vstore16(m.left, 0, (float*)pixels.history);
      vstore16(m.right, 1, (float*)pixels.history);
      vstore8(evidence.confidence, 0, pixels.confidence);
      vstore8(evidence.doubt, 0, pixels.doubt);
      vstore8(samples_x, 0, pixels.offset_x);
      vstore8(nearest_x, 0, pixels.x);
      const Surfaces surfaces = {moves, params.moves, params.move_x, params.move_y};
      correct_history(colour, &frame0, &surfaces, &pixels, nearest_y, samples_y);
      m.left = vload16(0, (const float*)pixels.history);
      m.right = vload16(1, (const float*)pixels.history);
      evidence.confidence = vload8(0, pixels.confidence);
      inertia = vload8(0, pixels.inertia);
    }

    const float8 away_x = samples_x * params.spacing_x;
    const float away_y = samples_y * params.spacing_y;
    const float8 narrowed = max(REACH - NARROWING * evidence.confidence, LEAST_REACH);
    const float8 reach = is_still(tile) ? narrowed : (float8)(REACH);
    const float8 near = max(1.0f - (away_x * away_x + away_y * away_y) / (reach * reach), 0.0f);
    float8 weight = near * near;
    EIGHT(LOAD);
    EightTexels samples = {(float16)(s0, s1, s2, s3), (float16)(s4, s5, s6, s7)};
    // Without bright and invalid samples each is worth 1.
    if (may_be_bright(samples)) met_count += weigh_samples(&samples, &weight, end - x);
    const float8 total = evidence.confidence + weight;
    const float8 part = weight / max(total + inertia, LEAST_WEIGHT);
    const float8 confidence = min(total, MOST_CONFIDENCE);
    const EightTexels sum = {add_samples(m.left, samples.left, part.lo, confidence.lo),
                             add_samples(m.right, samples.right, part.hi, confidence.hi)};
    store_history8(updated, y * params.output_width + x, end - x, sum);
    if (params.view != kViewPicture) {
      const View shown = view_of(params.view, tile, &motion, confidence, changed, from_x.fraction, from_y.fraction);
      EIGHT(SHOW);
    }
  }
  if (met_count > 0) atomic_add(non_finite + params.counter, met_count);
}
