// SPDX-License-Identifier: MIT
// The reprojection of eight output pixels of a row: that of the sample nearest to each.
#pragma once

#include "motion/motion_edge.h"
#include "temporal/frame_samples.h"
#include "texel.h"

// As Reprojection, but in output pixels; trust is never NaN, and a motion edge of either frame is positive.
typedef struct EightReprojections {
  float8 x, y, trust, motion_edge;
} EightReprojections;

// Returns the reprojection of pixels that stand still.
static inline EightReprojections no_motion(void) {
  const EightReprojections none = {(float8)(0.0f), (float8)(0.0f), (float8)(1.0f), (float8)(0.0f)};
  return none;
}

#if MOTION
static inline EightReprojections load_reprojections(const TemporalParams* params, __global const float* reprojection,
                                                    const NearestSamples* nearest) {
  const int8 x = nearest->x;
  __global const float* row = reprojection + 4 * row_index(params->reprojection, nearest->y);
  const float4 r0 = vload4(x.s0, row), r1 = vload4(x.s1, row), r2 = vload4(x.s2, row), r3 = vload4(x.s3, row);
  const float4 r4 = vload4(x.s4, row), r5 = vload4(x.s5, row), r6 = vload4(x.s6, row), r7 = vload4(x.s7, row);
  EightReprojections found;
  found.x = (float8)(r0.x, r1.x, r2.x, r3.x, r4.x, r5.x, r6.x, r7.x) * params->motion_x;
  found.y = (float8)(r0.y, r1.y, r2.y, r3.y, r4.y, r5.y, r6.y, r7.y) * params->motion_y;
  found.motion_edge = fabs((float8)(r0.w, r1.w, r2.w, r3.w, r4.w, r5.w, r6.w, r7.w));
  found.trust = fmax((float8)(r0.z, r1.z, r2.z, r3.z, r4.z, r5.z, r6.z, r7.z), (float8)(0.0f));  // NaN is none
  return found;
}
#elif REACTIVE
// Where nothing moves: the columns of the previous frame that show what eight samples do.
static inline int8 previous_columns(const TemporalParams* params, int8 x) {
  const float ratio = (float)params->frame1.width / (float)params->frame0.width;
  return min(convert_int8((convert_float8(x) + 0.5f) * ratio), (int8)(params->frame1.width - 1));
}

static inline int previous_row(const TemporalParams* params, int y) {
  const float ratio = (float)params->frame1.height / (float)params->frame0.height;
  return min((int)(((float)y + 0.5f) * ratio), params->frame1.height - 1);
}

// Returns the trust that the reactive values of both frames leave.
static inline float8 trust_of_reactive(const TemporalParams* params, REACTIVE_TEXELS reactive0,
                                       REACTIVE_TEXELS reactive1, const NearestSamples* nearest) {
  const TexelLayout now = params->frame0.reactive, before = params->frame1.reactive;
  const int8 x = previous_columns(params, nearest->x);
  const int y = previous_row(params, nearest->y);
  return (1.0f - (float8)(load_reactive4(reactive0, now, nearest->x.lo, nearest->y),
                          load_reactive4(reactive0, now, nearest->x.hi, nearest->y))) *
         (1.0f - (float8)(load_reactive4(reactive1, before, x.lo, y), load_reactive4(reactive1, before, x.hi, y)));
}

// True only if none of the samples of a row in rising columns x is reactive: eight are looked at together, in a buffer.
static inline bool none_is_reactive(REACTIVE_TEXELS texels, TexelLayout layout, int width, int8 x, int y) {
#if !ON_CPU
  return load_reactive4(texels, layout, x.lo, y).x == 0.0f;
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
static inline EightReprojections reproject_pixels(const TemporalParams* params, __global const float* reprojection,
                                                  REACTIVE_TEXELS reactive0, REACTIVE_TEXELS reactive1,
                                                  const NearestSamples* nearest) {
#if MOTION
  return load_reprojections(params, reprojection, nearest);
#else
  EightReprojections still = no_motion();
#if REACTIVE
  still.trust = trust_of_reactive(params, reactive0, reactive1, nearest);
#endif
  return still;
#endif
}
