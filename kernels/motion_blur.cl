// SPDX-License-Identifier: MIT
// motion_blur: simulates a shutter that closes at the time of this frame: each output pixel is the mean of the colours
// that lay under it at moments spread over the time that it was open.
//   params    in   extents, layouts, scale from velocity to streaks
//   axes      in   AxisTap of each output column, then of each output row: the sample that a pixel sees
//   blurs     in   TileBlur of motion_neighbours
//   source    in   RGBA32F or RGBA16F, output extent, linear, premultiplied, finite; a buffer
//   velocity  in   RG16F or RG32F, the viewport of the frame; NaN and Inf count as 0
//   depth     in   R32F, the same viewport, reversed and infinite; NaN counts as 0
//   output    out  as source; another buffer
// Options: SOURCE_FORMAT  HALF (default) | FLOAT   of source; OUTPUT_FORMAT is the same
//          SOURCE_STORAGE, VELOCITY_FORMAT as in texel.h, of velocity and depth
// A surface that moves by the streak s a shutter was at p, the fraction f of the shutter's time ago, if it is at p + f
// s now. Two such surfaces are looked for: one with the motion of the pixel's own surface and, where that is another
// motion, one with the longest streak around; the nearer of both counts. Where neither is found, p saw a surface
// that is hidden now: behind a nearer surface the place on the other side along the streak stands in, else the one
// beyond the edge. Reads stop at the outermost pixels.
// Source: McGuire et al. 2012; Guertin, McGuire, Nowrouzezahrai, "A Fast and Stable Feature-Aware Motion Blur Filter",
// 2014.
// Reference: tests/reference/motion_blur.cpp
#include "bits.h"
#include "motion/blur_params.h"
#include "motion/streaks.h"
#include "texel.h"

#if SOURCE_FORMAT != OUTPUT_FORMAT
#error "SOURCE_FORMAT and OUTPUT_FORMAT must be the same"
#endif

#define NEARER 1.01f  // ratio of two depths from which one surface is in front of the other

// Places of the output, one a lane.
typedef struct Places {
  LaneInt x, y;
} Places;

// A motion: a streak, and how far another one may be from it on each axis to be the same.
typedef struct Motion {
  LaneInt x, y;
  LaneInt tolerance;
} Motion;

// PoCL takes abs() of vectors apart.
static inline LaneInt magnitude(LaneInt value) {
  return max(value, -value);
}

// To half a pixel and a quarter of its length.
static inline Motion motion_of(LaneInt x, LaneInt y) {
  const LaneInt length = max(magnitude(x), magnitude(y));
  const Motion motion = {x, y, kStreakUnits / 2 + (length >> 2)};
  return motion;
}

// Samples of the viewport, and the streaks of the surfaces that they show.
typedef struct Samples {
  LaneInt x, y;
  LaneInt streak_x, streak_y;
} Samples;

static inline LaneMask moves_as(Samples samples, Motion motion) {
  const LaneInt away_x = magnitude(samples.streak_x - motion.x);
  const LaneInt away_y = magnitude(samples.streak_y - motion.y);
  return max(away_x, away_y) <= motion.tolerance;
}

// Everything that does not change over a row.
typedef struct Frame {
  const MotionParams* params;
  __global const AxisTap* columns;
  __global const AxisTap* rows;
} Frame;

// Where a surface that is at (x, y) after the moment `fraction` (of 256) was then seen from. Places are in 1 / (256 *
// kStreakUnits) pixels on the way.
static inline Places places_along(const MotionParams* params, LaneInt x, int y, LaneInt streak_x, LaneInt streak_y,
                                  LaneInt fraction) {
  const int half_pixel = 256 * kStreakUnits / 2;
  const LaneInt along_x = (x * (256 * kStreakUnits) + half_pixel + streak_x * fraction) >> 14;
  const LaneInt along_y = (y * (256 * kStreakUnits) + half_pixel + streak_y * fraction) >> 14;
  const Places places = {clamp(along_x, (LaneInt)(0), (LaneInt)(params->output_width - 1)),
                         clamp(along_y, (LaneInt)(0), (LaneInt)(params->output_height - 1))};
  return places;
}

static inline LaneInt nearest_at(__global const AxisTap* axis, LaneInt at) {
#if LANES == 8
  return (LaneInt)(axis[at.s0].nearest, axis[at.s1].nearest, axis[at.s2].nearest, axis[at.s3].nearest,
                   axis[at.s4].nearest, axis[at.s5].nearest, axis[at.s6].nearest, axis[at.s7].nearest);
#else
  return axis[at].nearest;
#endif
}

// The samples seen at places now.
static inline Samples samples_at(const Frame* frame, VELOCITY_TEXELS velocity, Places places) {
  const MotionParams* params = frame->params;
  const LaneInt x = nearest_at(frame->columns, places.x), y = nearest_at(frame->rows, places.y);
  const LaneFloat2 moves = load_velocities_at(velocity, params->velocity, x, y);
  const Samples samples = {x, y, streak_lanes(moves.x, params->scale_x), streak_lanes(moves.y, params->scale_y)};
  return samples;
}

static inline LaneFloat depths_of(const Frame* frame, DEPTH_TEXELS depth, Samples samples) {
  return load_settled_depths_at(depth, frame->params->depth, samples.x, samples.y);
}

static inline Places choose(Places otherwise, Places chosen, LaneMask where) {
  const Places places = {select(otherwise.x, chosen.x, where), select(otherwise.y, chosen.y, where)};
  return places;
}

// Pixels of a row, as far as they are known before any sample.
typedef struct Pixels {
  LaneInt x;
  int y;
  Motion own, passing;  // of their own surfaces, and of the longest streak around
  LaneFloat depth;
  LaneMask passed;  // a streak unlike their own reaches them
  bool any_passed, any_moves;
} Pixels;

static inline Pixels pixels_at(const Frame* frame, TileBlur blur, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth,
                               LaneInt x, int y) {
  const Places here = {x, (LaneInt)(y)};
  const Samples seen = samples_at(frame, velocity, here);
  Pixels pixels;
  pixels.x = x;
  pixels.y = y;
  pixels.own = motion_of(seen.streak_x, seen.streak_y);
  pixels.passing = motion_of((LaneInt)(blur.x), (LaneInt)(blur.y));
  pixels.depth = depths_of(frame, depth, seen);
  pixels.passed = mask_not(moves_as(seen, pixels.passing));
  pixels.any_passed = any_lane(pixels.passed);
  // Pixels that move by less than half a pixel stay on their own.
  const LaneInt length = max(magnitude(seen.streak_x), magnitude(seen.streak_y));
  pixels.any_moves = any_lane(length >= kStreakUnits / 2);
  return pixels;
}

// The places whose colour the pixels saw at a moment.
static inline Places places_seen(const Frame* frame, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth,
                                 const Pixels* pixels, LaneInt fraction) {
  const MotionParams* params = frame->params;
  const Motion own = pixels->own, passing = pixels->passing;
  const Places here = {pixels->x, (LaneInt)(pixels->y)};
  Places staying = here, from = here;
  Samples stayer, passer;
  LaneMask stays = mask_of(true), passes = mask_of(false);
  if (pixels->any_moves) {
    staying = places_along(params, pixels->x, pixels->y, own.x, own.y, fraction);
    stayer = samples_at(frame, velocity, staying);
    stays = moves_as(stayer, own);
  }
  if (pixels->any_passed) {
    from = places_along(params, pixels->x, pixels->y, passing.x, passing.y, fraction);
    passer = samples_at(frame, velocity, from);
    passes = pixels->passed & moves_as(passer, passing);
  }
  // Most often all stay, and depths do not matter.
  const LaneMask unseen = mask_not(passes | stays);
  if (!any_lane(passes | unseen)) return staying;
  LaneFloat stayer_depth = pixels->depth;
  if (pixels->any_moves) stayer_depth = depths_of(frame, depth, stayer);
  Places seen = staying;
  if (any_lane(passes)) {
    const LaneMask in_front = depths_of(frame, depth, passer) > stayer_depth * NEARER;
    seen = choose(seen, from, passes & (mask_not(stays) | in_front));
  }
  const LaneMask behind = stayer_depth > pixels->depth * NEARER;
  const LaneMask hidden = unseen & behind;
  if (any_lane(hidden)) {
    const Places mirrored = places_along(params, pixels->x, pixels->y, -own.x, -own.y, fraction);
    const Samples other = samples_at(frame, velocity, mirrored);
    seen = choose(seen, choose(here, mirrored, moves_as(other, own)), hidden);
  }
  return seen;
}

// The pixels from column `first` on; those beyond the last column repeat it.
static inline LaneTexels blurred(const Frame* frame, TileBlur blur, RESOLVED_TEXELS source, VELOCITY_TEXELS velocity,
                                 DEPTH_TEXELS depth, int first, int y, uint row_hash) {
  const MotionParams* params = frame->params;
  const LaneInt x = min(first + LANE_NUMBERS, (LaneInt)(params->output_width - 1));
  const LaneInt phase = as_lane_int(hash_lanes(as_lane_uint(LANE_NUMBERS) + ((uint)first + row_hash)) >> 24);
  Pixels pixels;
  if (blur.kind == kTileMixed) pixels = pixels_at(frame, blur, velocity, depth, x, y);
  LaneTexels sum = no_texels();
  const int samples = 1 << blur.samples_log2;
  for (int k = 0; k < samples; ++k) {
    const LaneInt fraction = (phase + 256 * k) >> blur.samples_log2;
    const Places places = blur.kind == kTileMixed
                              ? places_seen(frame, velocity, depth, &pixels, fraction)
                              : places_along(params, x, y, (LaneInt)(blur.x), (LaneInt)(blur.y), fraction);
    const LaneInt index = places.y * params->source.pitch + (places.x + params->source.offset);
    sum = add_texels(sum, gather_resolved(source, index));
  }
  return times(sum, (LaneFloat)(1.0f / (float)samples));
}

__kernel void motion_blur(const MotionParams params, __global const AxisTap* axes, __global const TileBlur* blurs,
                          RESOLVED_TEXELS source, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth, OUTPUT_TEXELS output) {
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(params.columns_per_item, params.output_width, kLanes);
  if (item.first >= item.end || y >= params.output_height) return;

  const Frame frame = {&params, axes, axes + params.row_axis};
  const uint row_hash = hash_of_row(y, 0);
  __global const TileBlur* row = blurs + y / kTileSide * params.tiles_x;
  for (int x = item.first; x < item.end; x += item.step) {
    const TileBlur blur = row[x / kTileSide];
    LaneTexels colours;
    if (blur.kind == kTileCopy) {
      colours = load_resolved_row(source, params.source, x, y, params.output_width);
    } else {
      colours = blurred(&frame, blur, source, velocity, depth, x, y, row_hash);
    }
    stream_output_lanes(output, params.output, x, y, pixels_from(item, x), colours);
  }
}
