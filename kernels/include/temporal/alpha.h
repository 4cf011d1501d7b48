// SPDX-License-Identifier: MIT
// Alpha of eight output pixels of a row on its way through resolve_temporal: it takes each of colour's steps, with
// colour's weights. Light is no matter of alpha, so it is not relit, and it is rectified without a tone curve.
#pragma once

#include "temporal/accumulate.h"
#include "temporal/fetch_history.h"
#include "temporal/history_alpha.h"
#include "temporal/rectify.h"

// What resample_history gives, of alpha.
#if TAPS == 36
static inline float8 resample_alpha(AlphaPlane plane, SourcePlaces from) {
  const int8 i = from.x.texel - 1, j = from.y.texel - 1;
  const SixByPlace wx = six_by_place(six_weights(from.x.fraction));
  const SixByPlace wy = six_by_place(six_weights(from.y.fraction));
  return (float8)(
      sample_alpha_six(plane, i.s0, j.s0, wx.p0, wy.p0), sample_alpha_six(plane, i.s1, j.s1, wx.p1, wy.p1),
      sample_alpha_six(plane, i.s2, j.s2, wx.p2, wy.p2), sample_alpha_six(plane, i.s3, j.s3, wx.p3, wy.p3),
      sample_alpha_six(plane, i.s4, j.s4, wx.p4, wy.p4), sample_alpha_six(plane, i.s5, j.s5, wx.p5, wy.p5),
      sample_alpha_six(plane, i.s6, j.s6, wx.p6, wy.p6), sample_alpha_six(plane, i.s7, j.s7, wx.p7, wy.p7));
}
#else
static inline float8 resample_alpha(AlphaPlane plane, SourcePlaces from) {
  const int8 i = from.x.texel, j = from.y.texel;
  const EightWeights wx = weights_by_place(cubic_weights(from.x.fraction, HISTORY_SHARPNESS));
  const EightWeights wy = weights_by_place(cubic_weights(from.y.fraction, HISTORY_SHARPNESS));
  return (float8)(sample_alpha(plane, i.s0, j.s0, wx.p0, wy.p0), sample_alpha(plane, i.s1, j.s1, wx.p1, wy.p1),
                  sample_alpha(plane, i.s2, j.s2, wx.p2, wy.p2), sample_alpha(plane, i.s3, j.s3, wx.p3, wy.p3),
                  sample_alpha(plane, i.s4, j.s4, wx.p4, wy.p4), sample_alpha(plane, i.s5, j.s5, wx.p5, wy.p5),
                  sample_alpha(plane, i.s6, j.s6, wx.p6, wy.p6), sample_alpha(plane, i.s7, j.s7, wx.p7, wy.p7));
}
#endif

// What fetch_history gives, of alpha.
static inline float8 fetch_alpha(AlphaPlane plane, __global const TileReprojection* previous,
                                 const TemporalParams* params, TileReprojection tile, bool copied,
                                 const EightReprojections* motion, int x, int y) {
  if (copied) return load_alpha8(plane, (y - tile.step_y) * plane.width + x - tile.step_x);
  return resample_alpha(plane, source_places(previous, params, tile, motion, x, y));
}

// Moves alpha by `rejection` of the way into the range of the valid ones of sample (x, y) and its four neighbours.
static inline float rectify_alpha(COLOUR_TEXELS texels, const SourceFrame* frame, int x, int y, float alpha,
                                  float rejection) {
  float first = 0.0f, sum = 0.0f, squares = 0.0f, count = 0.0f;
  for (int i = 0; i < 5; ++i) {
    const int column = (i == 1) - (i == 2), row = (i == 3) - (i == 4);
    const float4 sample = sample_at(texels, frame, x + column, y + row);
    if (!is_valid(sample)) continue;
    if (count == 0.0f) first = sample.w;
    const float difference = sample.w - first;
    sum += difference;
    squares += difference * difference;
    count += 1.0f;
  }
  if (count == 0.0f) return alpha;
  const float mean = sum / count;
  const float deviation = BOX_SIZE * sqrt(max(squares / count - mean * mean, 0.0f));
  const float middle = first + mean;
  return alpha + (clamp(alpha, middle - deviation, middle + deviation) - alpha) * rejection;
}

// The same of eight pixels.
static inline float8 rectify_alphas(COLOUR_TEXELS texels, const SourceFrame* frame, int8 x, int y, float8 alphas,
                                    float8 rejection) {
  float alpha[8], share[8];
  int column[8];
  vstore8(alphas, 0, alpha);
  vstore8(rejection, 0, share);
  vstore8(x, 0, column);
  for (int i = 0; i < 8; ++i) {
    if (share[i] > 0.0f) alpha[i] = rectify_alpha(texels, frame, column[i], y, alpha[i], share[i]);
  }
  return vload8(0, alpha);
}

// The alphas of eight samples.
static inline float8 alphas(EightTexels samples) {
  return (float8)(samples.left.s37bf, samples.right.s37bf);
}

// As accumulate.
static inline float8 accumulate_alpha(float8 history, float8 known, float8 inertia, EightTexels samples,
                                      float8 weight) {
  return history + (alphas(samples) - history) * sample_parts(known, inertia, weight);
}
