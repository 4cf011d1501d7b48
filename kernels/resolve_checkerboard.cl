// SPDX-License-Identifier: MIT
// resolve_checkerboard: a whole frame from one in which every other pixel is shaded. Shaded pixels keep every bit; a
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

#include "checkerboard/fill_colour.h"
#include "checkerboard/surfaces.h"

// Pixel i of four: all that it gets but colour is its neighbour's.
#define FILL(i, n)                                                                                                     \
  if (columns.s0 + 2 * n < end) {                                                                                      \
    const int to = columns.i, from_x = shown.x.i, from_y = shown.y.i;                                                  \
    copy_depth(shaded_depth, params.shaded.depth, from_x, from_y, depth, params.filled.depth, to, y);                  \
    FILL_VELOCITY(from_x, from_y, to)                                                                                  \
    FILL_REACTIVE(from_x, from_y, to)                                                                                  \
    const PastPixel near_pixel = {near.x.i, near.y.i, near.trust.i}, far_pixel = {far.x.i, far.y.i, far.trust.i};      \
    store_colour(colour, params.filled.colour, to, y,                                                                  \
                 filled_colour(&params, shaded_colour, previous_colour, to, y, near_pixel, far_pixel));                \
  }

#if VELOCITY
#define FILL_VELOCITY(from_x, from_y, to)                                                                              \
  copy_velocity(shaded_velocity, params.shaded.velocity, from_x, from_y, velocity, params.filled.velocity, to, y);
#else
#define FILL_VELOCITY(from_x, from_y, to)
#endif
#if REACTIVE
#define FILL_REACTIVE(from_x, from_y, to)                                                                              \
  copy_reactive(shaded_reactive, params.shaded.reactive, from_x, from_y, reactive, params.filled.reactive, to, y);
#else
#define FILL_REACTIVE(from_x, from_y, to)
#endif

__kernel void resolve_checkerboard(const CheckerboardParams params, COLOUR_TEXELS shaded_colour,
                                   VELOCITY_TEXELS shaded_velocity, DEPTH_TEXELS shaded_depth,
                                   REACTIVE_TEXELS shaded_reactive, COLOUR_TEXELS previous_colour,
                                   DEPTH_TEXELS previous_depth, STORED_COLOUR colour, STORED_VELOCITY velocity,
                                   STORED_DEPTH depth, STORED_REACTIVE reactive) {
  const int y = get_global_id(1);
  const int first = get_global_id(0) * params.columns_per_item;
  if (first >= params.width || y >= params.height) return;

  const int end = min(first + params.columns_per_item, params.width);
  const int shaded_from = (y & 1) != params.parity;  // of columns, which begin at an even one
  for (int x = first; x < end; x += kCheckerboardBlock) {
    for (int to = x + shaded_from; to < min(x + kCheckerboardBlock, end); to += 2) {
      copy_colour(shaded_colour, params.shaded.colour, colour, params.filled.colour, to, y);
      copy_depth(shaded_depth, params.shaded.depth, to, y, depth, params.filled.depth, to, y);
      FILL_VELOCITY(to, y, to)
      FILL_REACTIVE(to, y, to)
    }

    // Which surfaces lie around the others, and where they were.
    const int4 columns = x + 1 - shaded_from + (int4)(0, 2, 4, 6);
    const FourSurfaces around = surfaces_around(&params, shaded_depth, columns, y);
    const float4 whole = trust_in_reactive(&params, shaded_reactive, columns, y);
    const FourPasts near = past_of(&params, shaded_velocity, previous_depth, around.range, around.nearest, columns, y,
                                   whole);
    FourPasts far = near;
    if (any(near.trust < 1.0f)) {
      far = past_of(&params, shaded_velocity, previous_depth, around.range, around.farthest, columns, y, whole);
    }
    const FourNeighbours shown = shown_surfaces(&around, near.trust, far.trust);

    FILL(s0, 0)
    FILL(s1, 1)
    FILL(s2, 2)
    FILL(s3, 3)
  }
}
