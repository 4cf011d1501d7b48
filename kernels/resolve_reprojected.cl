// SPDX-License-Identifier: MIT
// resolve_reprojected: blends this frame with the previous one, whose samples are read where their surfaces were, each
// sample weighted by its distance.
//   out = (sum w0 h c0 + g sum w1 h c1) / (sum w0 h + g sum w1 h)
//   w1   of the 2x2 previous samples around q, the place in frame n-1 of what the sample nearest to the output pixel's
//        centre p shows: (1 - d^2/r^2)^3 on each axis, d in render pixels
//   w0   of the 2x2 samples around p: g times the same + (1 - g) times bilinear's, so that without trust the picture is
//        bilinear's, and becomes so steadily
//   h    1 / max(2, largest of red, green and blue), of exposed light: one bright sample does not outshine the others
//   g    the trust of that nearest sample
//
//   params              in   extents, layouts, falloffs 1 / r^2
//   positions0, 1       in   of each output column, then row, in each frame's viewport: texels, then fractions as bits.
//                            A position lies between samples `texel` and texel + 1, `fraction` of the way; texels may
//                            lie outside
//   colour0, colour1    in   RGBA16F or RGBA32F, viewports of frame n and n-1, linear, premultiplied
//   reprojection        in   MOTION 1: Reprojection of each sample of frame n, from reproject
//   reactive0, 1        in   REACTIVE 1 with MOTION 0: R8 of both frames; g = (1 - reactive0) (1 - reactive1)
//   output              out  RGBA32F or RGBA16F, output extent
//   non_finite          out  non_finite[params.counter] grows by the pixels with NaN or infinite input that counts
//   exposure            in   Exposure of frame n
// Options: MOTION    1 (default) | 0: nothing moves, q = p, g = 1 but for REACTIVE
//          REACTIVE  0 (default) | 1
//          SOURCE_STORAGE, SOURCE_FORMAT, OUTPUT_FORMAT as in texel.h
// Where a previous sample or the reprojection is not finite, g is 0: nothing survives into the next frame.
// Reference: tests/reference/resolve_reprojected.cpp
#include "arithmetic.h"
#include "bits.h"
#include "picture_params.h"
#include "texel.h"

#include "distance_weights.h"
#include "motion/motion_edge.h"
#include "resolve_params.h"

#define BRIGHT 2.0f  // of exposed light

// Values that a run of output pixels in one row shares.
typedef struct Row {
  int texel0, texel1;
  float fraction0, fraction1;
} Row;

static inline Row row_of(const ReprojectedParams* params, __global const int* positions0,
                         __global const int* positions1, int y) {
  const int texel = 2 * params->columns + y;
  const int fraction = texel + params->output_height;
  const Row row = {positions0[texel], positions1[texel], as_float(positions0[fraction]),
                   as_float(positions1[fraction])};
  return row;
}

#if MOTION
// Returns the motion of pixels, from the samples that are nearest to them.
static inline PixelMotion motion_of(const ReprojectedParams* params, __global const float* reprojection, LaneInt x,
                                    int y) {
  const LaneFloat4 own = gather4(reprojection + 4 * row_index(params->reprojection, y), x);
  const PixelMotion motion = {own.x, own.y, own.z};
  return motion;
}
#elif REACTIVE
// 1 - reactive of samples of a row.
static inline LaneFloat trust_of(REACTIVE_TEXELS reactive, TexelLayout layout, LaneInt x, int y) {
  return 1.0f - load_reactive_lanes(reactive, layout, x, y);
}
#endif

// The samples x and x + 1 of row y, each moved into the viewport.
static inline float8 careful_pair(COLOUR_TEXELS texels, const SourceFrame* frame, int x, int y) {
  const int row = min(y, frame->height - 1);
  return (float8)(load_colour(texels, frame->colour, x, row),
                  load_colour(texels, frame->colour, min(x + 1, frame->width - 1), row));
}

// The slow path: one pixel of any viewports and any values: NaN counts as 0, +-Inf as +-65504.
static inline float4 resolve_careful(const ReprojectedParams* params, COLOUR_TEXELS colour0, COLOUR_TEXELS colour1,
                                     int x0, int y0, int x1, int y1, float fraction0_x, float fraction0_y,
                                     float fraction1_x, float fraction1_y, float found_trust, float bright,
                                     bool* met) {
  const bool lost = (as_int(found_trust) & 0x7fffffff) >= NON_FINITE_BITS;
  float trust = lost ? 0.0f : found_trust;
  const LaneFloat now_x = (LaneFloat)(fraction0_x), now_y = (LaneFloat)(fraction0_y);
  const LaneFloat before_x = (LaneFloat)(fraction1_x), before_y = (LaneFloat)(fraction1_y);
  const SourceFrame* frame0 = &params->frame0;
  const SourceFrame* frame1 = &params->frame1;
  FourPairs samples = {careful_pair(colour0, frame0, x0, y0), careful_pair(colour0, frame0, x0, y0 + 1),
                       careful_pair(colour1, frame1, x1, y1), careful_pair(colour1, frame1, x1, y1 + 1)};
  Weights weights = weights_of(params, now_x, now_y, before_x, before_y, (LaneFloat)(trust));
  const float left = FIRST_LANE(weights.before_x0), right = FIRST_LANE(weights.before_x1);
  const float above = FIRST_LANE(weights.before_y0), below = FIRST_LANE(weights.before_y1);
  const bool met_before = counts_non_finite(samples.before0, left, right, above) ||
                          counts_non_finite(samples.before1, left, right, below);
  if (met_before) weights = weights_of(params, now_x, now_y, before_x, before_y, (LaneFloat)(0.0f));
  const PixelWeights own = PIXEL_WEIGHTS(weights, s0);
  *met = lost || met_before || counts_non_finite(samples.now0, own.now_x.s0, own.now_x.s4, own.now_y0) ||
         counts_non_finite(samples.now1, own.now_x.s0, own.now_x.s4, own.now_y1);
  samples.now0 = sanitise8(samples.now0);
  samples.now1 = sanitise8(samples.now1);
  samples.before0 = sanitise8(samples.before0);
  samples.before1 = sanitise8(samples.before1);
  return any_is_bright(magnitudes_of(samples), bright) ? blend_bright(samples, own, bright)
                                                       : blend_samples(samples, own);
}

// Pixel i of a block the fast way: into pixel_<i>.
#define RESOLVE(i)                                                                                                     \
  const FourPairs samples_##i = {                                                                                      \
      load_colour_pair(colour0, upper, LANE(now_x.texel, i)), load_colour_pair(colour0, lower, LANE(now_x.texel, i)),  \
      load_colour_pair_at(colour1, upper1, LANE(before, i), LANE(before_x.texel, i), LANE(before_y.texel, i)),         \
      load_colour_pair_at(colour1, lower1, LANE(before, i), LANE(before_x.texel, i), LANE(before_y.texel, i) + 1)};    \
  const float4 pixel_##i = blend_samples(samples_##i, PIXEL_WEIGHTS(weights, i));                                      \
  magnitudes = max(magnitudes, magnitudes_of(samples_##i))

// Pixel i of a block, its n-th, of which the first `count` exist.
#define RESOLVE_CAREFULLY(i, n)                                                                                        \
  if (n < count) {                                                                                                     \
    bool met = false;                                                                                                  \
    const float4 pixel =                                                                                               \
        resolve_careful(&params, colour0, colour1, LANE(now_x.texel, i), LANE(now_y.texel, i), LANE(before_x.texel, i),\
                        LANE(before_y.texel, i), LANE(now_x.fraction, i), LANE(now_y.fraction, i),                     \
                        LANE(before_x.fraction, i), LANE(before_y.fraction, i), LANE(motion.trust, i), bright, &met);  \
    store_output(output, params.output, x + n, y, pixel);                                                              \
    met_count += met;                                                                                                  \
  }

__kernel void resolve_reprojected(const ReprojectedParams params, __global const int* positions0,
                                  __global const int* positions1, COLOUR_TEXELS colour0, COLOUR_TEXELS colour1,
                                  __global const float* reprojection, REACTIVE_TEXELS reactive0,
                                  REACTIVE_TEXELS reactive1, OUTPUT_TEXELS output, __global uint* non_finite,
                                  __global const Exposure* exposure) {
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(params.columns_per_item, params.output_width, kLanes);
  if (item.first >= item.end || y >= params.output_height) return;

  const SourceFrame frame0 = params.frame0;
  const SourceFrame frame1 = params.frame1;
  const bool pairs = min(min(frame0.width, frame0.height), min(frame1.width, frame1.height)) > 1;
  const Row row = row_of(&params, positions0, positions1, y);
  const Positions row0 = {(LaneInt)(row.texel0), (LaneFloat)(row.fraction0)};
  const Positions row1 = {(LaneInt)(row.texel1), (LaneFloat)(row.fraction1)};
  const Positions now_y = moved_positions(row0, (LaneFloat)(0.0f), frame0.height - 1);
  COLOUR_ROW upper = colour_row(colour0, frame0.colour, FIRST_LANE(now_y.texel));
  COLOUR_ROW lower = colour_row(colour0, frame0.colour, min(FIRST_LANE(now_y.texel) + 1, frame0.height - 1));
  COLOUR_ROW upper1 = colour_row(colour1, frame1.colour, 0);
  COLOUR_ROW lower1 = colour_row(colour1, frame1.colour, 1);
  const float bright = BRIGHT * exposure->inverse;
  uint met_count = 0;
  for (int x = item.first; x < item.end; x += item.step) {
    const int count = pixels_from(item, x);
    const Positions column0 = load_positions(positions0, params.columns, x);
    const Positions column1 = load_positions(positions1, params.columns, x);
    const Positions now_x = moved_positions(column0, (LaneFloat)(0.0f), frame0.width - 1);
#if MOTION
    const PixelMotion motion =
        motion_of(&params, reprojection, nearest_samples(now_x), FIRST_LANE(nearest_samples(now_y)));
#else
    PixelMotion motion = {(LaneFloat)(0.0f), (LaneFloat)(0.0f), (LaneFloat)(1.0f)};
#if REACTIVE
    const Positions still_x = moved_positions(column1, (LaneFloat)(0.0f), frame1.width - 1);
    const Positions still_y = moved_positions(row1, (LaneFloat)(0.0f), frame1.height - 1);
    motion.trust = trust_of(reactive0, frame0.reactive, nearest_samples(now_x), FIRST_LANE(nearest_samples(now_y))) *
                   trust_of(reactive1, frame1.reactive, nearest_samples(still_x), FIRST_LANE(nearest_samples(still_y)));
#endif
#endif
    const Positions before_x = moved_positions(column1, motion.x, frame1.width - 1);
    const Positions before_y = moved_positions(row1, motion.y, frame1.height - 1);
    if (pairs) {
      const bool is_lost = any_lane((as_lane_int(motion.trust) & 0x7fffffff) >= NON_FINITE_BITS);
      const Weights weights = weights_of(&params, now_x.fraction, now_y.fraction, before_x.fraction, before_y.fraction,
                                         motion.trust);
      const LaneInt before = before_y.texel * frame1.colour.pitch + before_x.texel;
      int8 magnitudes = 0;
      RESOLVE(s0);
#if LANES == 8
      RESOLVE(s1);
      RESOLVE(s2);
      RESOLVE(s3);
      RESOLVE(s4);
      RESOLVE(s5);
      RESOLVE(s6);
      RESOLVE(s7);
      if (!is_lost && !any_is_bright(magnitudes, bright)) {
        const FourPixels left = {pixel_s0, pixel_s1, pixel_s2, pixel_s3};
        const FourPixels right = {pixel_s4, pixel_s5, pixel_s6, pixel_s7};
        store_four(output, params.output, x, y, x + count, left);
        if (count > 4) store_four(output, params.output, x + 4, y, x + count, right);
        continue;
      }
#else
      if (!is_lost && !any_is_bright(magnitudes, bright)) {
        store_output(output, params.output, x, y, pixel_s0);
        continue;
      }
#endif
    }
    RESOLVE_CAREFULLY(s0, 0)
#if LANES == 8
    RESOLVE_CAREFULLY(s1, 1)
    RESOLVE_CAREFULLY(s2, 2)
    RESOLVE_CAREFULLY(s3, 3)
    RESOLVE_CAREFULLY(s4, 4)
    RESOLVE_CAREFULLY(s5, 5)
    RESOLVE_CAREFULLY(s6, 6)
    RESOLVE_CAREFULLY(s7, 7)
#endif
  }
  if (met_count) atomic_add(non_finite + params.counter, met_count);
}
