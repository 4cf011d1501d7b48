// SPDX-License-Identifier: MIT
// reproject: finds the place in the previous frame of each sample's surface, and the trust in history there.
//   trust = (1 - reactive0) (1 - reactive1) inside visible / (1 + K |v0 - v1|^2)
//   inside   falls from 1 at the previous frame's edge to 0 a pixel beyond it
//   visible  1 if at least one of the 2x2 previous depths at that place does not lie in front of the sample's surface,
//            else 0. A depth d1 lies in front of d0 if d1 > (1.02 d0 + 2 slope) nearer, d being reversed depth, near /
//            distance; slope is the smaller difference of d0 to left and right + that to above and below. nearer is how
//            many times nearer a surface at rest was before the camera's last step, 1 if it was farther away; a camera
//            that is not known stands still. The test is one-sided, so that thin things that fall between samples are
//            not lost
//   v0, v1, reactive0, 1: of the sample, and of the previous sample nearest to the place where it was; v in render
//            pixels a frame. With MOTION_EDGE reactive is the largest of 3x3 and, in the previous frame, of 5x5
//
//   params                 in   viewports, layouts, scales
//   velocity0, 1           in   RG16F or RG32F, viewports of frames n and n-1; RESIDUAL 0: velocity1 is not read
//   depth0, 1              in   R32F, the same viewports, reversed and infinite; NaN does not count
//   reactive0, 1           in   REACTIVE 1: R8, the same viewports; 0: the frames may be mixed, 1: they may not
//   previous_reprojection  in   MOTION_EDGE 1: what this kernel wrote for frame n-1; all zero where there is none
//   reprojection           out  Reprojection of each sample of frame n
//   open_trust             out  OPEN_TRUST 1: of each sample, row by row, trust without visible and motion edges; with
//                               a minus sign where one of those in `reprojection` is more than LAYER_MOTION_MIN
// Options: REACTIVE     0 (default) | 1
//          RESIDUAL     0 (default) | 1: K is not 0
//          MOTION_EDGE  0 (default) | 1: the motion edge at each sample is found as well. Where one of the 2x2 previous
//                       depths lies in front of the sample's surface and there was a motion edge, the sample counts as
//                       disoccluded: what accumulated there is the nearer surface's, too
//          OPEN_TRUST   0 (default) | 1: with MOTION_EDGE 1
//          SOURCE_STORAGE, VELOCITY_FORMAT as in texel.h
// A sample whose velocity or depth is not finite stands still, and its trust is NaN.
// Reference: tests/reference/reproject.cpp
#include "bits.h"
#include "texels/surfaces.h"

#ifndef REACTIVE
#define REACTIVE 0
#endif
#ifndef RESIDUAL
#define RESIDUAL 0
#endif
#ifndef MOTION_EDGE
#define MOTION_EDGE 0
#endif
#ifndef OPEN_TRUST
#define OPEN_TRUST 0
#endif
#if REACTIVE < 0 || REACTIVE > 1
#error "REACTIVE must be 0 or 1"
#endif
#if RESIDUAL < 0 || RESIDUAL > 1
#error "RESIDUAL must be 0 or 1"
#endif
#if MOTION_EDGE < 0 || MOTION_EDGE > 1
#error "MOTION_EDGE must be 0 or 1"
#endif
#if OPEN_TRUST < 0 || OPEN_TRUST > MOTION_EDGE
#error "OPEN_TRUST must be 0 or, with MOTION_EDGE 1, 1"
#endif

#if OPEN_TRUST
#include "layers/constants.h"
#endif
#include "motion/reproject_samples.h"
#include "motion/velocity_params.h"

#define NAN_BITS 0x7fc00000

// Towards minus infinity, of less than 2^24.
static inline int4 floor_of(float4 value) {
  const int4 whole = convert_int4(value);
  return whole + (convert_float4(whole) > value);
}

// 1 inside [low, low + length], 0 from a pixel away on.
static inline float4 inside_of(float4 at, float low, float length) {
  return clamp(1.0f - max(low - at, at - (low + length)), 0.0f, 1.0f);
}

static inline int8 both_axes(int4 lanes) {
  return (int8)(lanes.s0, lanes.s0, lanes.s1, lanes.s1, lanes.s2, lanes.s2, lanes.s3, lanes.s3);
}

static inline int4 non_finite_velocity(float8 velocity) {
  return non_finite_lanes(velocity.even) | non_finite_lanes(velocity.odd);
}

// Reprojection of four samples.
typedef struct FourReprojections {
  float4 x, y, trust, motion_edge;
} FourReprojections;

// The first `count` of four.
static inline void store_reprojections(__global float* reprojection, int index, int count, FourReprojections r) {
  __global float* first = reprojection + 4 * index;
  vstore4((float4)(r.x.s0, r.y.s0, r.trust.s0, r.motion_edge.s0), 0, first);
  if (count > 1) vstore4((float4)(r.x.s1, r.y.s1, r.trust.s1, r.motion_edge.s1), 1, first);
  if (count > 2) vstore4((float4)(r.x.s2, r.y.s2, r.trust.s2, r.motion_edge.s2), 2, first);
  if (count > 3) vstore4((float4)(r.x.s3, r.y.s3, r.trust.s3, r.motion_edge.s3), 3, first);
}

#if OPEN_TRUST
// The first `count` of four.
static inline void store_floats(__global float* floats, int count, float4 value) {
  floats[0] = value.s0;
  if (count > 1) floats[1] = value.s1;
  if (count > 2) floats[2] = value.s2;
  if (count > 3) floats[3] = value.s3;
}
#endif

enum { kSamplesAhead = 32, kReprojectionAhead = 16 };  // to prefetch

// The samples below (x, y) are read soon.
static inline void will_read_below(const ReprojectParams* params, VELOCITY_TEXELS velocity, DEPTH_TEXELS depth, int x,
                                   int y) {
#if SOURCE_STORAGE == BUFFER
  WILL_READ(velocity + 2 * texel_index(params->velocity0, x + kSamplesAhead, y + 1));
  WILL_READ(depth + texel_index(params->depth0, x + kSamplesAhead, y + 1));
#endif
}

__kernel void reproject(const ReprojectParams params, VELOCITY_TEXELS velocity0, VELOCITY_TEXELS velocity1,
                        DEPTH_TEXELS depth0, DEPTH_TEXELS depth1, REACTIVE_TEXELS reactive0, REACTIVE_TEXELS reactive1,
                        __global const float* previous_reprojection, __global float* reprojection,
                        __global float* open_trust) {
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(params.columns_per_item, params.width, kBlock);
  if (item.first >= item.end || y >= params.height) return;

  const float row = (float)y * params.step_y + params.start_y;
  const int4 last_x = max(params.previous_width - 2, 0);
  const int4 last_y = max(params.previous_height - 2, 0);
  for (int x = item.first; x < item.end; x += item.step) {
    const int count = pixels_from(item, x);  // one lane asks for one of four; compilers drop the work for the others
    will_read_below(&params, velocity0, depth0, x, y);
    WILL_WRITE(reprojection + 4 * (texel_index(params.reprojection, x, y) + kReprojectionAhead));
    const float4 depth = load_depth_block(depth0, params.depth0, x, y, params.width);
    const float8 input = load_velocity_block(velocity0, params.velocity0, x, y, params.width);
    int4 lost = non_finite_lanes(depth) | non_finite_velocity(input);
    const float8 velocity = as_float8(select(as_int8(input), (int8)(0), both_axes(lost)));

    // Reproject.
    FourReprojections found;
    found.x = clamp(velocity.even * params.motion_x, -FINITE_HALF_MAX, FINITE_HALF_MAX);
    found.y = clamp(velocity.odd * params.motion_y, -FINITE_HALF_MAX, FINITE_HALF_MAX);
    const float4 at_x = convert_float4(x + (int4)(0, 1, 2, 3)) * params.step_x + params.start_x + found.x;
    const float4 at_y = row + found.y;

    // Compare depths.
    const float4 limit = nearest_of_same(&params, depth0, x, y, depth);
    const DepthRange before = previous_depths(&params, depth1, clamp(floor_of(at_x), (int4)(0), last_x),
                                              clamp(floor_of(at_y), (int4)(0), last_y));

    // Trust what was on the screen, not reactive, and moved alike.
    float4 trust = inside_of(at_x, params.edge_x, (float)params.previous_width) *
                   inside_of(at_y, params.edge_y, (float)params.previous_height);
#if REACTIVE || RESIDUAL || MOTION_EDGE
    const int4 nearest_x = clamp(floor_of(at_x + 0.5f), (int4)(0), (int4)(params.previous_width - 1));
    const int4 nearest_y = clamp(floor_of(at_y + 0.5f), (int4)(0), (int4)(params.previous_height - 1));
#endif
#if REACTIVE
    trust *= 1.0f - reactive_at(&params, reactive0, x, y);
    trust *= 1.0f - previous_reactive_at(&params, reactive1, nearest_x, nearest_y);
#endif
#if RESIDUAL
    const float8 velocity_before = load_velocity_at(velocity1, params.velocity1, nearest_x, nearest_y);
    lost |= non_finite_velocity(velocity_before);
    const float4 residual_x = velocity.even * params.speed0_x - velocity_before.even * params.speed1_x;
    const float4 residual_y = velocity.odd * params.speed0_y - velocity_before.odd * params.speed1_y;
    trust /= 1.0f + residual_x * residual_x + residual_y * residual_y;
#endif
    const float4 visible = select((float4)(0.0f), trust, before.least <= limit);
    found.trust = as_float4(select(as_int4(visible), (int4)(NAN_BITS), lost));

    // Find motion edges, and trust nothing that a nearer surface's edge has mixed in.
#if MOTION_EDGE
    const float4 edge = motion_edges_at(&params, velocity0, x, y, velocity);
    const float4 previous_edge = previous_motion_edges(&params, previous_reprojection, nearest_x, nearest_y);
    const float4 kept = 1.0f - edge_rejection4(previous_edge);
    found.trust *= select((float4)(1.0f), kept, before.most > limit);
    found.motion_edge = select(edge, -previous_edge, previous_edge > edge);
#else
    found.motion_edge = (float4)(0.0f);
#endif
#if OPEN_TRUST
    const int4 has_edge = fabs(found.motion_edge) > LAYER_MOTION_MIN;  // -1, or 0
    store_floats(open_trust + y * params.width + x, count, copysign(trust, as_float4(has_edge)));
#endif
    store_reprojections(reprojection, texel_index(params.reprojection, x, y), count, found);
  }
}
