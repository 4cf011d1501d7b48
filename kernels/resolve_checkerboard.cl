// SPDX-License-Identifier: MIT
// resolve_checkerboard: fills a frame of which every other pixel is shaded. Shaded pixels keep every bit; a
// pixel between them gets, of its four neighbours, which are shaded,
//   colour    t0 h0 + (1 - t0) (t1 h1 + (1 - t1) s)
//   h0, h1    the previous frame's filled colour, bilinear, where the nearest and the farthest surface among the
//             neighbours were: from the pixel's centre back along their motion; within the neighbours' range
//   t0, t1    trust: how far the previous depth there is the surface's, inside the previous viewport, and
//             1 - the largest reactive value of the neighbours
//   s         the mean of left and right, and that of above and below, by how alike the two of each pair are
//   the rest  depth, velocity and reactive value of the neighbour whose surface it shows: the nearest where t0 is at
//             least 1/2, the farthest where (1 - t0) t1 is, else the nearer one of the pair whose depths are closer
// Reversed depth is linear over a plane's picture, so that its previous value may be taken between samples. It is the
// surface's within 2 % + half the difference of nearest and farthest neighbour, and not from half as much again.
//
//   params                in   extents, layouts, parity, scales
//   shaded_colour         in   RGBA16F or RGBA32F, viewport, linear, premultiplied; pixels that are not shaded are not
//                              read, in any of these
//   shaded_velocity       in   MOTION TARGET: RG16F or RG32F, viewport
//   shaded_depth          in   R32F, viewport, reversed and infinite; what is not finite is no surface
//   shaded_reactive       in   REACTIVE 1: R8, viewport
//   previous_colour       in   what this kernel wrote for frame n-1, its viewport
//   previous_depth        in   the same of depth
//   colour                out  as shaded_colour, viewport
//   velocity              out  VELOCITY 1: as shaded_velocity
//   depth                 out  R32F, viewport
//   reactive              out  REACTIVE 1: R8, viewport
// Options: MOTION    TARGET (default) | CAMERA: velocity follows from depth and the camera | NONE: nothing moves
//          VELOCITY  0 (default) | 1: with MOTION TARGET, velocity is filled
//          REACTIVE  0 (default) | 1
//          SOURCE_STORAGE, SOURCE_FORMAT, VELOCITY_FORMAT as in texel.h
// A neighbour whose colour is not finite does not count, and previous colour that is not is not trusted.
// Sources: McFerron and Lake, "Checkerboard Rendering for Real-Time Upscaling on Intel Integrated Graphics", 2018;
// Wihlidal, "4K Checkerboard in Battlefield 1 and Mass Effect Andromeda", 2017; El Mansouri, "Rendering Rainbow Six
// Siege", 2016.   Reference: tests/reference/resolve_checkerboard.cpp
#define NONE 1
#define TARGET 2
#define CAMERA 3
#ifndef MOTION
#define MOTION TARGET
#endif
#ifndef VELOCITY
#define VELOCITY 0
#endif
#ifndef REACTIVE
#define REACTIVE 0
#endif
#if MOTION != NONE && MOTION != TARGET && MOTION != CAMERA
#error "MOTION must be NONE, TARGET or CAMERA"
#endif
#if VELOCITY < 0 || VELOCITY > (MOTION == TARGET)
#error "VELOCITY must be 0 or, with MOTION TARGET, 1"
#endif
#if REACTIVE < 0 || REACTIVE > 1
#error "REACTIVE must be 0 or 1"
#endif

#include "bits.h"
#include "checkerboard/every_other.h"
#include "checkerboard/fill_colour.h"

#if MOTION == TARGET
#define MOTION_OF(surface) motion_of(velocity_on(surfaces.surface, velocities))
#elif MOTION == CAMERA
#define MOTION_OF(surface) camera_motion(&params, x, y, surfaces.surface##_depth)
#else
#define MOTION_OF(surface) no_motion()
#endif

__kernel void resolve_checkerboard(const CheckerboardParams params, COLOUR_TEXELS shaded_colour,
                                   VELOCITY_TEXELS shaded_velocity, DEPTH_TEXELS shaded_depth,
                                   REACTIVE_TEXELS shaded_reactive, COLOUR_TEXELS previous_colour,
                                   DEPTH_TEXELS previous_depth, STORED_COLOUR colour, STORED_VELOCITY velocity,
                                   STORED_DEPTH depth, STORED_REACTIVE reactive) {
  const int y = get_global_id(1);
  const ItemColumns pairs = columns_of_item(params.columns_per_item / 2, (params.width + 1) / 2, kLanes);
  if (pairs.first >= pairs.end || y >= params.height) return;

  const bool shaded_first = (y & 1) == params.parity;  // the first column is shaded; runs begin at an even one
  for (int pair = pairs.first; pair < pairs.end; pair += pairs.step) {
    const int run = 2 * pair;
    const int count = min(min(2 * pairs.end, params.width) - run, (int)kRun);
    const int x = run + shaded_first;  // the first pixel that is not shaded

    // Which surfaces lie around, and where they were.
    const DepthsAround depths = depths_around(&params, shaded_depth, x, y);
    const DepthsAround settled = settled_depths(&params, depths, x, y);
    const Surfaces surfaces = surfaces_of(settled);
    const LaneFloat range = surfaces.nearest_depth - surfaces.farthest_depth;
    LaneFloat whole = (LaneFloat)(1.0f);
#if REACTIVE
    const ReactiveAround marks = reactive_around(&params, shaded_reactive, x, y);
    whole = trust_in(marks);
#endif
#if MOTION == TARGET
    const VelocitiesAround velocities = velocities_around(&params, shaded_velocity, x, y);
#endif
    Past nearest = no_past(), farthest = no_past();
    if (params.has_history) {
      nearest = past_of(&params, previous_depth, x, y, surfaces.nearest_depth, MOTION_OF(nearest), surfaces.is_surface,
                        range, whole);
    }
    Sides shown = surfaces.nearest;
    if (any_lane(nearest.trust < 1.0f)) {
      if (params.has_history) {
        farthest = past_of(&params, previous_depth, x, y, surfaces.farthest_depth, MOTION_OF(farthest),
                           surfaces.is_surface, range, whole);
      }
      const LaneMask shows_farthest = (1.0f - nearest.trust) * farthest.trust >= 0.5f;
      const Sides hidden = select(likely_sides(settled, surfaces.nearest), surfaces.farthest, shows_farthest);
      shown = select(hidden, surfaces.nearest, nearest.trust >= 0.5f);
    }

    // All that the pixels get but colour is a neighbour's.
    const LaneFloat filled_depth = depth_on(shown, depths);
    store_depths_in_turn(depth, params.filled.depth, run, y, count, shaded_first ? depths.left : filled_depth,
                         shaded_first ? filled_depth : depths.right);
#if VELOCITY
    const VelocityBits filled_velocity = velocity_on(shown, velocities);
    store_velocities_in_turn(velocity, params.filled.velocity, run, y, count,
                             shaded_first ? velocities.left : filled_velocity,
                             shaded_first ? filled_velocity : velocities.right);
#endif
#if REACTIVE
    const LaneUint filled_reactive = reactive_on(shown, marks);
    store_reactive_in_turn(reactive, params.filled.reactive, run, y, count,
                           shaded_first ? marks.left : filled_reactive, shaded_first ? filled_reactive : marks.right);
#endif

    const TexelLayout layout = params.shaded.colour;
    const ColourBits left = load_every_other_colour(shaded_colour, layout, x - 1, y, params.width);
    const ColourBits right = load_every_other_colour(shaded_colour, layout, x + 1, y, params.width);
    const ColourBits above = load_every_other_colour(shaded_colour, layout, x, row_above(y), params.width);
    const ColourBits below = load_every_other_colour(shaded_colour, layout, x, row_below(&params, y), params.width);
    const LanesAround around = colours_around(&params, left, right, above, below, x, y);
    const ColourBits filled = bits_of(fill_colours(&params, previous_colour, around, nearest, farthest));
    if (shaded_first)
      store_colours_in_turn(colour, params.filled.colour, run, y, count, left, filled);
    else
      store_colours_in_turn(colour, params.filled.colour, run, y, count, filled, right);
  }
}
