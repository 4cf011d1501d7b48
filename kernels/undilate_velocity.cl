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

// The dilated depths of the samples in the lanes, from x on, and of those left and right of each.
typedef struct DilatedDepths {
  LaneFloat left, own, right;
} DilatedDepths;

#if LANES == 8
// The depths of columns x - 2 to x + 5, clamped to the edge.
static inline float8 load_depth_columns(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width) {
#if SOURCE_STORAGE == BUFFER
  if (x >= 2 && x + 5 < width) return vload8(0, texels + texel_index(layout, x - 2, y));
#endif
  return (float8)(load_depth4(texels, layout, block_columns(x - 2, width), y),
                  load_depth4(texels, layout, block_columns(x + 2, width), y));
}

// The largest depth in each of those columns of three rows.
static inline float8 most_of_columns(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width, int height) {
  const float8 above = load_depth_columns(texels, layout, x, max(y - 1, 0), width);
  const float8 row = load_depth_columns(texels, layout, x, y, width);
  const float8 below = load_depth_columns(texels, layout, x, min(y + 1, height - 1), width);
  return fmax(fmax(above, row), below);
}

static inline DilatedDepths load_dilated_depths(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width,
                                                int height) {
  const float8 a = most_of_columns(texels, layout, x, y, width, height);
  const float8 b = most_of_columns(texels, layout, x + 4, y, width, height);
  const float8 c1 = (float8)(a.s1234, b.s1234), c2 = (float8)(a.s2345, b.s2345), c3 = (float8)(a.s3456, b.s3456);
  const DilatedDepths depths = {fmax(fmax((float8)(a.s0123, b.s0123), c1), c2), fmax(fmax(c1, c2), c3),
                                fmax(fmax(c2, c3), (float8)(a.s4567, b.s4567))};
  return depths;
}
#else
// The largest depth of a column, clamped to the edge, in three rows.
static inline float most_of_column(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width, int height) {
  const int column = clamp(x, 0, width - 1);
  return fmax(fmax(load_depth(texels, layout, column, max(y - 1, 0)), load_depth(texels, layout, column, y)),
              load_depth(texels, layout, column, min(y + 1, height - 1)));
}

static inline DilatedDepths load_dilated_depths(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width,
                                                int height) {
  const float c0 = most_of_column(texels, layout, x - 2, y, width, height);
  const float c1 = most_of_column(texels, layout, x - 1, y, width, height);
  const float c2 = most_of_column(texels, layout, x, y, width, height);
  const float c3 = most_of_column(texels, layout, x + 1, y, width, height);
  const float c4 = most_of_column(texels, layout, x + 2, y, width, height);
  const DilatedDepths depths = {fmax(fmax(c0, c1), c2), fmax(fmax(c1, c2), c3), fmax(fmax(c2, c3), c4)};
  return depths;
}
#endif

// That of one sample; that of the sample alone where it is more than `limit`, which says enough.
static inline float load_dilated_depth(DEPTH_TEXELS texels, TexelLayout layout, int x, int y, int width, int height,
                                       float limit) {
  float most = load_depth(texels, layout, x, y);
  for (int j = max(y - 1, 0); j <= min(y + 1, height - 1) && !(most > limit); ++j) {
    for (int i = max(x - 1, 0); i <= min(x + 1, width - 1); ++i) most = fmax(most, load_depth(texels, layout, i, j));
  }
  return most;
}

// Stores the velocities of columns before `end`.
static inline void store_velocities(STORED_VELOCITY texels, TexelLayout layout, int x, int y, int end, LaneFloat2 v) {
#if LANES == 8
  const float8 left = (float8)(v.x.s0, v.y.s0, v.x.s1, v.y.s1, v.x.s2, v.y.s2, v.x.s3, v.y.s3);
  const float8 right = (float8)(v.x.s4, v.y.s4, v.x.s5, v.y.s5, v.x.s6, v.y.s6, v.x.s7, v.y.s7);
  store_velocity4(texels, layout, x, y, end, left);
  if (x + 4 < end) store_velocity4(texels, layout, x + 4, y, end, right);
#else
  store_velocity4(texels, layout, x, y, x + 1, (float8)(v.x, v.y, v.x, v.y, v.x, v.y, v.x, v.y));
#endif
}

static inline LaneFloat2 select_velocities(LaneFloat2 otherwise, LaneFloat2 velocity, LaneMask mask) {
  const LaneFloat2 taken = {select(otherwise.x, velocity.x, mask), select(otherwise.y, velocity.y, mask)};
  return taken;
}

// Samples of a row that look for a neighbour of their own depth, and the velocity of the closest so far.
typedef struct Searches {
  LaneFloat depth, closest;
  LaneFloat2 velocity;
} Searches;

// The neighbours in the columns from x on of row y, of these dilated depths.
static inline void look_at(Searches* found, const UndilateParams* params, VELOCITY_TEXELS velocities, int x, int y,
                           LaneFloat dilated) {
  const LaneInt column = x + LANE_NUMBERS;
  const LaneFloat apart = fabs(dilated - found->depth);
  const LaneMask is_closer = (apart < found->closest) & (column >= 0) & (column < params->frame.width);
  if (!any_lane(is_closer)) return;
  const LaneFloat2 velocity = load_velocity_row(velocities, params->dilated, x, y, params->frame.width);
  found->closest = select(found->closest, apart, is_closer);
  found->velocity = select_velocities(found->velocity, velocity, is_closer);
}

static inline void look_around(Searches* found, const UndilateParams* params, VELOCITY_TEXELS velocities,
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

// Takes the velocities that are `missing` from two to REACH samples away. Lanes that find none keep their velocity and
// their mark.
static inline void look_afar(const UndilateParams* params, VELOCITY_TEXELS velocities, DEPTH_TEXELS depths, int x,
                             int y, LaneFloat depth, LaneFloat2* velocity, LaneMask* missing) {
  for (int i = 0; i < kLanes; ++i) {
    if (FIRST_LANE(*missing)) {
      const int2 place = place_of_same(params, depths, x + i, y, FIRST_LANE(depth));
      if (place.x >= 0) {
        const float2 there = load_velocity(velocities, params->dilated, place.x, place.y);
        FIRST_LANE(velocity->x) = there.x;
        FIRST_LANE(velocity->y) = there.y;
        FIRST_LANE(*missing) = 0;
      }
    }
    depth = NEXT_LANES(depth);
    velocity->x = NEXT_LANES(velocity->x);
    velocity->y = NEXT_LANES(velocity->y);
    *missing = NEXT_LANES(*missing);
  }
}

static inline LaneFloat2 camera_velocities(const UndilateParams* params, int x, int y, LaneFloat depth) {
  __private const CameraVelocity* camera = &params->frame.camera;
  const float ndc_y = (float)y * camera->step_y + camera->start_y;
  const LaneFloat2 moved = velocities_of(to_lane_float(x + LANE_NUMBERS), ndc_y, depth, camera);
  const LaneFloat2 drawn = {clamp(moved.x * params->to_drawn_x, -FINITE_HALF_MAX, FINITE_HALF_MAX),
                             clamp(moved.y * params->to_drawn_y, -FINITE_HALF_MAX, FINITE_HALF_MAX)};
  return drawn;
}

__kernel void undilate_velocity(const UndilateParams params, DEPTH_TEXELS depth, VELOCITY_TEXELS dilated,
                                STORED_VELOCITY velocity) {
  const VelocityParams frame = params.frame;
  const int y = get_global_id(1), width = frame.width;
  const ItemColumns item = columns_of_item(frame.columns_per_item, width, kLanes);
  if (item.first >= item.end || y >= frame.height) return;

  for (int x = item.first; x < item.end; x += item.step) {
    const int end = x + pixels_from(item, x);
    LaneFloat2 found = load_velocity_row(dilated, params.dilated, x, y, width);
    const LaneInt columns = min(x + LANE_NUMBERS, (LaneInt)(width - 1));
    const LaneFloat own = load_depth_lanes(depth, frame.depth, columns, y);
    const DilatedDepths row = load_dilated_depths(depth, frame.depth, x, y, width, frame.height);
    const LaneMask is_taken = (row.own > own) & (own >= 0.0f) & (x + LANE_NUMBERS < end);
    if (any_lane(is_taken)) {
      const LaneFloat tolerance = own * SAME_SURFACE;
      const LaneMask is_covered = is_taken & (row.own - own > tolerance);
      Searches search = {own, (LaneFloat)(INFINITY), found};
      look_around(&search, &params, dilated, depth, x, y, row);
      const LaneMask is_found =
          is_taken & (search.closest <= select((LaneFloat)(0.0f), tolerance, is_covered));
      found = select_velocities(found, search.velocity, is_found);
      LaneMask missing = is_covered & mask_not(is_found);
      if (any_lane(missing)) {
        look_afar(&params, dilated, depth, x, y, own, &found, &missing);
        if (params.has_camera) found = select_velocities(found, camera_velocities(&params, x, y, own), missing);
      }
    }
    store_velocities(velocity, frame.velocity, x, y, end, found);
  }
}
