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

// Four places of the output.
typedef struct Places {
  int4 x;
  int4 y;
} Places;

// Surfaces seen there now.
typedef struct Surfaces {
  int4 streak_x;
  int4 streak_y;
  float4 depth;
} Surfaces;

// Everything that does not change over a row.
typedef struct Frame {
  const MotionParams* params;
  __global const AxisTap* columns;
  __global const AxisTap* rows;
} Frame;

// Where a surface that is at (x, y) after the moment `fraction` (of 256) was then seen from. Places are in 1 / (256 *
// kStreakUnits) pixels on the way.
static inline Places places_along(const MotionParams* params, int4 x, int y, int4 streak_x, int4 streak_y,
                                  int4 fraction) {
  const int4 half_pixel = 256 * kStreakUnits / 2;
  const int4 along_x = (x * (256 * kStreakUnits) + half_pixel + streak_x * fraction) >> 14;
  const int4 along_y = ((int4)(y * (256 * kStreakUnits)) + half_pixel + streak_y * fraction) >> 14;
  const Places places = {clamp(along_x, (int4)(0), (int4)(params->output_width - 1)),
                         clamp(along_y, (int4)(0), (int4)(params->output_height - 1))};
  return places;
}

static inline int4 nearest_at(__global const AxisTap* axis, int4 at) {
  return (int4)(axis[at.s0].nearest, axis[at.s1].nearest, axis[at.s2].nearest, axis[at.s3].nearest);
}

static inline Surfaces surfaces_at(const Frame* frame, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth, Places places) {
  const MotionParams* params = frame->params;
  const int4 x = nearest_at(frame->columns, places.x);
  const int4 y = nearest_at(frame->rows, places.y);
  const int8 streaks =
      streaks_of(load_velocity_at(velocity, params->velocity, x, y), params->scale_x, params->scale_y);
  const Surfaces surfaces = {streaks.even, streaks.odd, load_settled_depth_at(depth, params->depth, x, y)};
  return surfaces;
}

// Whether one of the pixels that count is -1.
static inline bool any_pixel(int4 pixels) {
  return LANES == 8 ? any(pixels) : pixels.s0 != 0;
}

// Whether surfaces move as a streak says, to half a pixel and a quarter of its length.
static inline int4 moves_as(Surfaces surfaces, int4 streak_x, int4 streak_y) {
  const uint4 away = max(abs_diff(surfaces.streak_x, streak_x), abs_diff(surfaces.streak_y, streak_y));
  const uint4 length = max(abs(streak_x), abs(streak_y));
  return as_int4(away) <= as_int4((uint)(kStreakUnits / 2) + (length >> 2));
}

static inline Places choose(Places otherwise, Places chosen, int4 where) {
  const Places places = {select(otherwise.x, chosen.x, where), select(otherwise.y, chosen.y, where)};
  return places;
}

// Four pixels, as far as they are known before any sample.
typedef struct Pixels {
  int4 x;
  int y;
  Surfaces own;
  int4 passed;  // a streak unlike their own reaches them
  bool any_passed;
  bool any_moves;
} Pixels;

static inline Pixels pixels_at(const Frame* frame, TileBlur blur, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth, int4 x,
                               int y) {
  const Places here = {x, (int4)(y)};
  Pixels pixels;
  pixels.x = x;
  pixels.y = y;
  pixels.own = surfaces_at(frame, velocity, depth, here);
  pixels.passed = ~moves_as(pixels.own, (int4)(blur.x), (int4)(blur.y));
  pixels.any_passed = any_pixel(pixels.passed);
  // Pixels that move by less than half a pixel stay on their own.
  pixels.any_moves = any_pixel(max(abs(pixels.own.streak_x), abs(pixels.own.streak_y)) >= (uint4)(kStreakUnits / 2));
  return pixels;
}

// The places whose colour the pixels saw at a moment.
static inline Places places_seen(const Frame* frame, TileBlur blur, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth,
                                 const Pixels* pixels, int4 fraction) {
  const MotionParams* params = frame->params;
  const Surfaces own = pixels->own;
  Places staying = {pixels->x, (int4)(pixels->y)};
  Surfaces stayer = own;
  int4 stays = -1;
  if (pixels->any_moves) {
    staying = places_along(params, pixels->x, pixels->y, own.streak_x, own.streak_y, fraction);
    stayer = surfaces_at(frame, velocity, depth, staying);
    stays = moves_as(stayer, own.streak_x, own.streak_y);
  }
  Places seen = staying;
  int4 passes = 0;
  if (pixels->any_passed) {
    const Places passing = places_along(params, pixels->x, pixels->y, (int4)(blur.x), (int4)(blur.y), fraction);
    const Surfaces passer = surfaces_at(frame, velocity, depth, passing);
    passes = pixels->passed & moves_as(passer, (int4)(blur.x), (int4)(blur.y));
    seen = choose(seen, passing, passes & (~stays | (passer.depth > stayer.depth * NEARER)));
  }
  const int4 hidden = ~(passes | stays) & (stayer.depth > own.depth * NEARER);
  if (any_pixel(hidden)) {
    const Places here = {pixels->x, (int4)(pixels->y)};
    const Places mirrored = places_along(params, pixels->x, pixels->y, -own.streak_x, -own.streak_y, fraction);
    const Surfaces other = surfaces_at(frame, velocity, depth, mirrored);
    seen = choose(seen, choose(here, mirrored, moves_as(other, own.streak_x, own.streak_y)), hidden);
  }
  return seen;
}

static inline void add_colours(FourPixels* sum, RESOLVED_TEXELS source, TexelLayout layout, Places places) {
  sum->p0 += load_resolved(source, layout, places.x.s0, places.y.s0);
  if (LANES == 1) return;
  sum->p1 += load_resolved(source, layout, places.x.s1, places.y.s1);
  sum->p2 += load_resolved(source, layout, places.x.s2, places.y.s2);
  sum->p3 += load_resolved(source, layout, places.x.s3, places.y.s3);
}

// The pixels from column `first` on; those beyond the last column repeat it.
static inline FourPixels blurred(const Frame* frame, TileBlur blur, RESOLVED_TEXELS source, VELOCITY_TEXELS velocity,
                                 DEPTH_TEXELS depth, int first, int y, uint row_hash) {
  const MotionParams* params = frame->params;
  const int4 x = min((int4)(first, first + 1, first + 2, first + 3), (int4)(params->output_width - 1));
  const int4 phase = as_int4(hash_of4((uint4)(0, 1, 2, 3) + ((uint)first + row_hash)) >> 24);
  Pixels pixels;
  if (blur.kind == kTileMixed) pixels = pixels_at(frame, blur, velocity, depth, x, y);
  FourPixels sum = {(float4)(0.0f), (float4)(0.0f), (float4)(0.0f), (float4)(0.0f)};
  const int samples = 1 << blur.samples_log2;
  for (int k = 0; k < samples; ++k) {
    const int4 fraction = (phase + 256 * k) >> blur.samples_log2;
    const Places places =
        blur.kind == kTileMixed
            ? places_seen(frame, blur, velocity, depth, &pixels, fraction)
            : places_along(params, x, y, (int4)(blur.x), (int4)(blur.y), fraction);
    add_colours(&sum, source, params->source, places);
  }
  const float share = 1.0f / (float)samples;
  sum.p0 *= share;
  sum.p1 *= share;
  sum.p2 *= share;
  sum.p3 *= share;
  return sum;
}

__kernel void motion_blur(const MotionParams params, __global const AxisTap* axes, __global const TileBlur* blurs,
                          RESOLVED_TEXELS source, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth, OUTPUT_TEXELS output) {
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(params.columns_per_item, params.output_width, kBlock);
  if (item.first >= item.end || y >= params.output_height) return;

  const Frame frame = {&params, axes, axes + params.row_axis};
  const uint row_hash = hash_of_row(y, 0);
  __global const TileBlur* row = blurs + y / kTileSide * params.tiles_x;
  for (int x = item.first; x < item.end; x += item.step) {
    const int end = x + pixels_from(item, x);
    const TileBlur blur = row[x / kTileSide];
    if (blur.kind == kTileCopy) {
      FourPixels colour;
      colour.p0 = load_resolved(source, params.source, x, y);
      if (LANES == 8) {
        colour.p1 = load_resolved(source, params.source, min(x + 1, end - 1), y);
        colour.p2 = load_resolved(source, params.source, min(x + 2, end - 1), y);
        colour.p3 = load_resolved(source, params.source, min(x + 3, end - 1), y);
      }
      store_four(output, params.output, x, y, end, colour);
    } else {
      store_four(output, params.output, x, y, end, blurred(&frame, blur, source, velocity, depth, x, y, row_hash));
    }
  }
}
