// SPDX-License-Identifier: MIT
// The reprojection of output pixels of a row: that of the sample nearest to each.
#pragma once

#include "layers/layer.h"
#include "motion/motion_edge.h"
#include "temporal/frame_samples.h"
#include "texel.h"

// As Reprojection, but in output pixels; trust is never NaN, and a motion edge of either frame is positive.
typedef struct Reprojections {
  LaneFloat x, y, trust, motion_edge;
  LaneMask is_split;  // samples with two layers
} Reprojections;

// Returns the reprojection of pixels that stand still.
static inline Reprojections no_motion(void) {
  const Reprojections none = {(LaneFloat)(0.0f), (LaneFloat)(0.0f), (LaneFloat)(1.0f), (LaneFloat)(0.0f),
                              mask_of(false)};
  return none;
}

#if MOTION
static inline Reprojections load_reprojections(const TemporalParams* params, __global const float* reprojection,
                                               const NearestSamples* nearest) {
  __global const float* row = reprojection + 4 * row_index(params->reprojection, nearest->y);
  const LaneFloat4 own = gather4(row, nearest->x);
  Reprojections found;
  found.x = own.x * params->motion_x;
  found.y = own.y * params->motion_y;
  found.motion_edge = fabs(own.w);
  found.is_split = as_lane_int(own.w) == SPLIT_MOTION_EDGE_BITS;
  found.trust = fmax(own.z, (LaneFloat)(0.0f));  // NaN is none
  return found;
}
#elif REACTIVE
// Where nothing moves: the columns of the previous frame that show what the samples do.
static inline LaneInt previous_columns(const TemporalParams* params, LaneInt x) {
  const float ratio = (float)params->frame1.width / (float)params->frame0.width;
  return min(to_lane_int((to_lane_float(x) + 0.5f) * ratio), (LaneInt)(params->frame1.width - 1));
}

static inline int previous_row(const TemporalParams* params, int y) {
  const float ratio = (float)params->frame1.height / (float)params->frame0.height;
  return min((int)(((float)y + 0.5f) * ratio), params->frame1.height - 1);
}

// Returns the trust that the reactive values of both frames leave.
static inline LaneFloat trust_of_reactive(const TemporalParams* params, REACTIVE_TEXELS reactive0,
                                          REACTIVE_TEXELS reactive1, const NearestSamples* nearest) {
  const TexelLayout now = params->frame0.reactive, before = params->frame1.reactive;
  const LaneInt x = previous_columns(params, nearest->x);
  const int y = previous_row(params, nearest->y);
  return (1.0f - load_reactive_lanes(reactive0, now, nearest->x, nearest->y)) *
         (1.0f - load_reactive_lanes(reactive1, before, x, y));
}

// True only if none of the samples of a row in rising columns x is reactive: eight are looked at together, in a buffer.
static inline bool none_is_reactive(REACTIVE_TEXELS texels, TexelLayout layout, int width, LaneInt x, int y) {
#if LANES == 1
  return load_reactive_lanes(texels, layout, x, y) == 0.0f;
#elif SOURCE_STORAGE == BUFFER
  const int first = min(x.s0, width - 8);
  if (first < 0 || x.s7 - first >= 8) return false;
  return as_long(vload8(0, texels + texel_index(layout, first, y))) == 0;
#else
  return false;
#endif
}
#endif

// Whether all samples of a row of the tile are trusted, so that the pixels' reprojection need not be looked at.
static inline bool are_trusted(const TemporalParams* params, REACTIVE_TEXELS reactive0, REACTIVE_TEXELS reactive1,
                               const NearestSamples* nearest, TileReprojection tile) {
  if (!tile.is_trusted) return false;
#if REACTIVE && !MOTION
  return none_is_reactive(reactive0, params->frame0.reactive, params->frame0.width, nearest->x, nearest->y) &&
         none_is_reactive(reactive1, params->frame1.reactive, params->frame1.width,
                          previous_columns(params, nearest->x), previous_row(params, nearest->y));
#else
  return true;
#endif
}

// Reprojects the pixels.
static inline Reprojections reproject_pixels(const TemporalParams* params, __global const float* reprojection,
                                             REACTIVE_TEXELS reactive0, REACTIVE_TEXELS reactive1,
                                             const NearestSamples* nearest) {
#if MOTION
  return load_reprojections(params, reprojection, nearest);
#else
  Reprojections still = no_motion();
#if REACTIVE
  still.trust = trust_of_reactive(params, reactive0, reactive1, nearest);
#endif
  return still;
#endif
}
