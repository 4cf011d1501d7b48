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

// 1 inside [low, low + length], 0 from a pixel away on.
static inline LaneFloat inside_of(LaneFloat at, float low, float length) {
  return clamp(1.0f - max(low - at, at - (low + length)), 0.0f, 1.0f);
}

#if LANES == 8
// As float4s: halves of wide vectors would be put together by permutations that take longer.
static inline void store_four(__global float* reprojection, float4 x, float4 y, float4 trust, float4 motion_edge) {
  vstore4((float4)(x.s0, y.s0, trust.s0, motion_edge.s0), 0, reprojection);
  vstore4((float4)(x.s1, y.s1, trust.s1, motion_edge.s1), 1, reprojection);
  vstore4((float4)(x.s2, y.s2, trust.s2, motion_edge.s2), 2, reprojection);
  vstore4((float4)(x.s3, y.s3, trust.s3, motion_edge.s3), 3, reprojection);
}
#endif

// Stores the first `count`.
static inline void store_reprojections(__global float* reprojection, int count, LaneFloat2 motion, LaneFloat trust,
                                       LaneFloat motion_edge) {
#if LANES == 8
  if (count >= kLanes) {
    store_four(reprojection, motion.x.lo, motion.y.lo, trust.lo, motion_edge.lo);
    store_four(reprojection + 16, motion.x.hi, motion.y.hi, trust.hi, motion_edge.hi);
    return;
  }
#endif
  LaneTexels texels = texels_of(motion.x, motion.y, trust, motion_edge);
  for (int i = 0; i < count; ++i) {
    vstore4(first_texel(texels), i, reprojection);
    texels = push_texel(texels, first_texel(texels));
  }
}

#if OPEN_TRUST
// The same.
static inline void store_floats(__global float* floats, int count, LaneFloat values) {
#if LANES == 8
  if (count >= kLanes) {
    vstore8(values, 0, floats);
    return;
  }
#endif
  for (int i = 0; i < count; ++i) {
    floats[i] = FIRST_LANE(values);
    values = NEXT_LANES(values);
  }
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
  const ItemColumns item = columns_of_item(params.columns_per_item, params.width, kLanes);
  if (item.first >= item.end || y >= params.height) return;

  const float row = (float)y * params.step_y + params.start_y;
  const LaneInt first = (LaneInt)(0);
  const LaneInt last_x = (LaneInt)(max(params.previous_width - 2, 0));
  const LaneInt last_y = (LaneInt)(max(params.previous_height - 2, 0));
  for (int x = item.first; x < item.end; x += item.step) {
    const int count = pixels_from(item, x);
    will_read_below(&params, velocity0, depth0, x, y);
    const int index = texel_index(params.reprojection, x, y);
    WILL_WRITE(reprojection + 4 * (index + kReprojectionAhead));
    WILL_WRITE(reprojection + 4 * (index + kReprojectionAhead + 4));
    const LaneFloat depth = load_depth_row(depth0, params.depth0, x, y, params.width);
    const LaneFloat2 input = load_velocity_row(velocity0, params.velocity0, x, y, params.width);
    const LaneFloat none = (LaneFloat)(0.0f);
    LaneInt largest = max(magnitude_bits(depth), max(magnitude_bits(input.x), magnitude_bits(input.y)));
    const LaneFloat2 velocity = {select(input.x, none, largest >= NON_FINITE_BITS),
                                 select(input.y, none, largest >= NON_FINITE_BITS)};

    // Reproject.
    const LaneFloat2 motion = {clamp(velocity.x * params.motion_x, -FINITE_HALF_MAX, FINITE_HALF_MAX),
                               clamp(velocity.y * params.motion_y, -FINITE_HALF_MAX, FINITE_HALF_MAX)};
    const LaneFloat at_x = to_lane_float(x + LANE_NUMBERS) * params.step_x + params.start_x + motion.x;
    const LaneFloat at_y = row + motion.y;

    // Compare depths.
    const LaneFloat limit = nearest_of_same(&params, depth0, x, y, depth);
    const DepthRanges before = previous_depths(&params, depth1, clamp(floor_lanes(at_x), first, last_x),
                                               clamp(floor_lanes(at_y), first, last_y));

    // Trust what was on the screen, not reactive, and moved alike.
    LaneFloat trust = inside_of(at_x, params.edge_x, (float)params.previous_width) *
                      inside_of(at_y, params.edge_y, (float)params.previous_height);
#if REACTIVE || RESIDUAL || MOTION_EDGE
    const LaneInt nearest_x = clamp(floor_lanes(at_x + 0.5f), first, (LaneInt)(params.previous_width - 1));
    const LaneInt nearest_y = clamp(floor_lanes(at_y + 0.5f), first, (LaneInt)(params.previous_height - 1));
#endif
#if REACTIVE
    trust *= 1.0f - reactive_at(&params, reactive0, x, y);
    trust *= 1.0f - previous_reactive_at(&params, reactive1, nearest_x, nearest_y);
#endif
#if RESIDUAL
    const LaneFloat2 moved_before = load_velocities_at(velocity1, params.velocity1, nearest_x, nearest_y);
    largest = max(largest, max(magnitude_bits(moved_before.x), magnitude_bits(moved_before.y)));
    const LaneFloat residual_x = velocity.x * params.speed0_x - moved_before.x * params.speed1_x;
    const LaneFloat residual_y = velocity.y * params.speed0_y - moved_before.y * params.speed1_y;
    trust /= 1.0f + residual_x * residual_x + residual_y * residual_y;
#endif
    const LaneFloat visible = select(none, trust, before.least <= limit);
    const LaneInt visible_bits = as_lane_int(visible);
    LaneFloat found_trust = as_lane_float(select(visible_bits, (LaneInt)(NAN_BITS), largest >= NON_FINITE_BITS));

    // Find motion edges, and trust nothing that a nearer surface's edge has mixed in.
    LaneFloat motion_edge = none;
#if MOTION_EDGE
    const LaneFloat edge = motion_edges_at(&params, velocity0, x, y, input);
    const LaneFloat previous_edge = previous_motion_edges(&params, previous_reprojection, nearest_x, nearest_y);
    const LaneFloat kept = 1.0f - edge_rejection(previous_edge);
    found_trust *= select((LaneFloat)(1.0f), kept, before.most > limit);
    motion_edge = select(edge, -previous_edge, previous_edge > edge);
#endif
#if OPEN_TRUST
    const LaneFloat sign = select((LaneFloat)(1.0f), (LaneFloat)(-1.0f), fabs(motion_edge) > LAYER_MOTION_MIN);
    store_floats(open_trust + y * params.width + x, count, copysign(trust, sign));
#endif
    store_reprojections(reprojection + 4 * index, count, motion, found_trust, motion_edge);
  }
}
