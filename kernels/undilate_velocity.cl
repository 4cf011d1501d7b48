// SPDX-License-Identifier: MIT
// undilate_velocity: gives each sample its own velocity back where it has that of the nearest of its 3x3 samples, as
// many renderers write it. The velocity of a sample i belongs to a surface of the depth D(i), the largest of its 3x3.
//   D(i) = d(i)           i has its own velocity
//   D(i) <= d(i) 33 / 32  i has that of a sample of its own surface. It gets that of the first of its eight neighbours
//                         k with D(k) = d(i), which is its own exactly; if there is none it keeps what it has
//   else                  i has that of something before it. It gets that of the neighbour k whose D(k) is closest to
//                         d(i), if that is within d(i) / 32; if there is none, of such a sample two columns or rows
//                         away, and so on to REACH; if there is none, that of the camera's motion, where it is known;
//                         else it keeps its own
// Where samples are equally close, the first counts, row by row. A NaN in depth is no surface, and a sample that has
// it, or a depth of less than 0, keeps its velocity.
//   params    in   viewport, layouts, camera motion
//   depth     in   R32F, viewport, reversed and infinite: 0 at infinity
//   dilated   in   RG16F or RG32F, viewport, in the caller's units
//   velocity  out  the same format and units, viewport: values of `dilated`, or the camera's, within +-65504
// Options: SOURCE_STORAGE (of depth and velocities), VELOCITY_FORMAT as in texel.h
// Reference: tests/reference/undilate_velocity.cpp
#include "bits.h"
#include "motion/camera_velocity.h"
#include "motion/velocity_params.h"
#include "texels/surfaces.h"

#define REACH 8                      // samples, found by search on the development scenes
#define SAME_SURFACE (1.0f / 32.0f)  // fraction of a depth; a power of two, so that the product is exact

// The depths of columns x - 2 to x + 5, clamped to the edge.
static inline float8 load_depth_columns(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width) {
#if SOURCE_STORAGE == BUFFER
  if (x >= 2 && x + 5 < width) return vload8(0, texels + texel_index(layout, x - 2, y));
#endif
  return (float8)(load_depth4(texels, layout, block_columns(x - 2, width), y),
                  load_depth4(texels, layout, block_columns(x + 2, width), y));
}

// The dilated depths of four samples of a row, x to x + 3, and of those left and right of each.
typedef struct DilatedDepths {
  float4 left, own, right;
} DilatedDepths;

static inline DilatedDepths load_dilated_depths(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width,
                                                int height) {
  const float8 above = load_depth_columns(texels, layout, x, max(y - 1, 0), width);
  const float8 row = load_depth_columns(texels, layout, x, y, width);
  const float8 below = load_depth_columns(texels, layout, x, min(y + 1, height - 1), width);
  const float8 most = fmax(fmax(above, row), below);
  const DilatedDepths depths = {fmax(fmax(most.s0123, most.s1234), most.s2345),
                                fmax(fmax(most.s1234, most.s2345), most.s3456),
                                fmax(fmax(most.s2345, most.s3456), most.s4567)};
  return depths;
}

// That of one sample; that of the sample alone where it is more than `limit`, which says enough.
static inline float load_dilated_depth(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width, int height,
                                       float limit) {
  float most = load_depth(texels, layout, x, y);
  for (int j = max(y - 1, 0); j <= min(y + 1, height - 1) && !(most > limit); ++j) {
    for (int i = max(x - 1, 0); i <= min(x + 1, width - 1); ++i) most = fmax(most, load_depth(texels, layout, i, j));
  }
  return most;
}

static inline int8 both_axes(int4 lanes) {
  return (int8)(lanes.s0, lanes.s0, lanes.s1, lanes.s1, lanes.s2, lanes.s2, lanes.s3, lanes.s3);
}

static inline float8 select_velocities(float8 otherwise, float8 velocity, int4 lanes) {
  return as_float8(select(as_int8(otherwise), as_int8(velocity), both_axes(lanes)));
}

// Four samples of a row that look for a neighbour of their own depth, and the velocity of the closest so far.
typedef struct FourSearches {
  float4 depth, closest;
  float8 velocity;
} FourSearches;

// The neighbours in columns x to x + 3 of row y, of these dilated depths.
static inline void look_at(FourSearches* found, const UndilateParams* params, VELOCITY_TEXELS velocities, int x, int y,
                           float4 dilated) {
  const int4 column = x + (int4)(0, 1, 2, 3);
  const float4 apart = fabs(dilated - found->depth);
  const int4 is_closer = (apart < found->closest) & (column >= 0) & (column < params->frame.width);
  if (!any(is_closer)) return;
  const float8 velocity = load_velocity_block(velocities, params->dilated, x, y, params->frame.width);
  found->closest = select(found->closest, apart, is_closer);
  found->velocity = select_velocities(found->velocity, velocity, is_closer);
}

static inline void look_around(FourSearches* found, const UndilateParams* params, VELOCITY_TEXELS velocities,
                               DEPTH_TEXELS depths, int x, int y, DilatedDepths own_row) {
  const int width = params->frame.width, height = params->frame.height;
  for (int row = max(y - 1, 0); row <= min(y + 1, height - 1); ++row) {
    DilatedDepths dilated = own_row;
    if (row != y) dilated = load_dilated_depths(depths, params->frame.depth, x, row, width, height);
    look_at(found, params, velocities, x - 1, row, dilated.left);
    if (row != y) look_at(found, params, velocities, x, row, dilated.own);
    look_at(found, params, velocities, x + 1, row, dilated.right);
  }
}

// The sample two to REACH columns or rows away whose velocity one of this depth gets; x is -1 if there is none.
static inline int2 place_of_same(const UndilateParams* params, DEPTH_TEXELS depths, int x, int y, float depth) {
  const int width = params->frame.width, height = params->frame.height;
  const float tolerance = depth * SAME_SURFACE;
  int2 place = -1;
  float closest = 0.0f;
  for (int ring = 2; ring <= REACH && place.x < 0; ++ring) {
    for (int j = max(y - ring, 0); j <= min(y + ring, height - 1); ++j) {
      const int step = abs(j - y) == (uint)ring ? 1 : 2 * ring;
      for (int i = x - ring; i <= x + ring; i += step) {
        if (i < 0 || i >= width) continue;
        const float nearest =
            load_dilated_depth(depths, params->frame.depth, i, j, width, height, depth + tolerance);
        const float apart = fabs(nearest - depth);
        if (!(apart <= tolerance) || (place.x >= 0 && apart >= closest)) continue;
        place = (int2)(i, j);
        closest = apart;
      }
    }
  }
  return place;
}

// Returns four samples' velocities, with those that are `missing` taken from two to REACH samples away. Lanes that find
// none keep their velocity and their mark.
static inline float8 look_afar(const UndilateParams* params, VELOCITY_TEXELS velocities, DEPTH_TEXELS depths, int x,
                               int y, float4 depth, float8 velocity, int4* missing) {
  for (int i = 0; i < kBlock; ++i) {
    const int4 lane = ((int4)(0, 1, 2, 3) == i) & *missing;
    if (!any(lane)) continue;
    const float own = i == 0 ? depth.s0 : i == 1 ? depth.s1 : i == 2 ? depth.s2 : depth.s3;
    const int2 place = place_of_same(params, depths, x + i, y, own);
    if (place.x < 0) continue;
    const float2 there = load_velocity(velocities, params->dilated, place.x, place.y);
    velocity = select_velocities(velocity, (float8)(there, there, there, there), lane);
    *missing &= ~lane;
  }
  return velocity;
}

static inline float8 camera_velocities(const UndilateParams* params, int x, int y, float4 depth) {
  __private const CameraVelocity* camera = &params->frame.camera;
  const float ndc_y = (float)y * camera->step_y + camera->start_y;
  const float2 unit = (float2)(params->to_drawn_x, params->to_drawn_y);
  const float8 moved = velocity_of(convert_float4(x + (int4)(0, 1, 2, 3)), ndc_y, depth, camera);
  return clamp(moved * (float8)(unit, unit, unit, unit), -FINITE_HALF_MAX, FINITE_HALF_MAX);
}

__kernel void undilate_velocity(const UndilateParams params, DEPTH_TEXELS depth, VELOCITY_TEXELS dilated,
                                STORED_VELOCITY velocity) {
  const VelocityParams frame = params.frame;
  const int y = get_global_id(1);
  const int first = get_global_id(0) * frame.columns_per_item;
  if (first >= frame.width || y >= frame.height) return;

  const int end = min(first + frame.columns_per_item, frame.width);
  for (int x = first; x < end; x += kBlock) {
    float8 found = load_velocity_block(dilated, params.dilated, x, y, frame.width);
    const float4 own = load_depth_block(depth, frame.depth, x, y, frame.width);
    const DilatedDepths row = load_dilated_depths(depth, frame.depth, x, y, frame.width, frame.height);
    const int4 is_taken = (row.own > own) & (own >= 0.0f) & (x + (int4)(0, 1, 2, 3) < end);
    if (any(is_taken)) {
      const float4 tolerance = own * SAME_SURFACE;
      const int4 is_covered = is_taken & (row.own - own > tolerance);
      FourSearches search = {own, INFINITY, found};
      look_around(&search, &params, dilated, depth, x, y, row);
      const int4 is_found = is_taken & (search.closest <= select((float4)(0.0f), tolerance, is_covered));
      found = select_velocities(found, search.velocity, is_found);
      int4 missing = is_covered & ~is_found;
      if (any(missing)) {
        found = look_afar(&params, dilated, depth, x, y, own, found, &missing);
        if (params.has_camera) found = select_velocities(found, camera_velocities(&params, x, y, own), missing);
      }
    }
    store_velocity4(velocity, frame.velocity, x, y, end, found);
  }
}
