// SPDX-License-Identifier: MIT
// lay_focus: lays the picture of a region over the picture, weighted by rectangles and a mask.
//   params  in      the part that is laid over, layouts, rectangles
//   focus   in      RGBA32F or RGBA16F, the region's extent, linear, premultiplied; a buffer
//   mask    in      R8, the region's extent: 0 keeps the picture, 255 leaves the weight of the rectangles as it is; a
//                   buffer, read with MASK=1 only
//   output  in/out  as focus, output extent: the picture. Pixels of weight 0 are not touched
// Options: MASK           0 (default) | 1
//          SOURCE_FORMAT  HALF (default) | FLOAT   of focus; OUTPUT_FORMAT is the same
// A pixel at the distance d within a rectangle has the weight t t (3 - 2 t), t = min(d rate, 1); of several rectangles
// the largest counts. At weight 1 the focus is copied. Between, out = picture (1 - weight) + focus weight, where NaN
// counts as 0 and +-Inf as +-65504.
// Source: Binks, "Dynamic Resolution Rendering", 2012: higher quality over a smaller area of the image.
// Reference: tests/reference/lay_focus.cpp
#ifndef MASK
#define MASK 0
#endif
#include "bits.h"
#include "picture_params.h"
#include "texel.h"
#if MASK != 0 && MASK != 1
#error "MASK must be 0 or 1"
#endif
#if SOURCE_FORMAT != OUTPUT_FORMAT
#error "SOURCE_FORMAT and OUTPUT_FORMAT must be the same"
#endif

// Returns the weights of four neighbours of a row of the region, from x on.
static inline float4 rectangle_weights(const FocusParams* params, int x, int y) {
  const float4 centre_x = (float)x + (float4)(0.5f, 1.5f, 2.5f, 3.5f);
  const float centre_y = (float)y + 0.5f;
  float4 weights = 0.0f;
  for (int i = 0; i < params->rectangle_count; ++i) {
    const FocusRectangle inside = params->rectangles[i];
    const float above_or_below = fmin(centre_y - inside.top, inside.bottom - centre_y);
    const float4 distance = fmin(fmin(centre_x - inside.left, inside.right - centre_x), (float4)(above_or_below));
    const float4 t = clamp(distance * inside.rate, 0.0f, 1.0f);
    weights = fmax(weights, t * t * (3.0f - 2.0f * t));
  }
  return weights;
}

// Returns the weights of those that lie before `end`, and 0 for the others.
static inline float4 weights_of(const FocusParams* params, __global const uchar* mask, int x, int y, int end) {
  const int4 columns = x + (int4)(0, 1, 2, 3);
  float4 weights = rectangle_weights(params, x, y);
#if MASK
  __global const uchar* row = mask + row_index(params->mask, y);
  const int4 inside = min(columns, (int4)(end - 1));
  const int4 codes = (int4)(row[inside.s0], row[inside.s1], row[inside.s2], row[inside.s3]);
  weights *= convert_float4(codes) / 255.0f;
#endif
  return select((float4)(0.0f), weights, columns < (int4)(end));
}

static inline void lay_pixel(RESOLVED_TEXELS focus, OUTPUT_TEXELS output, const FocusParams* params, int x, int y,
                             float weight) {
  if (!(weight > 0.0f)) return;
  const float4 near = load_resolved(focus, params->focus, x, y);
  if (weight >= 1.0f) {
    store_output(output, params->output, x, y, near);
    return;
  }
  const float4 under = sanitise4(load_resolved(output, params->output, x, y));
  store_output(output, params->output, x, y, under * (1.0f - weight) + sanitise4(near) * weight);
}

__kernel void lay_focus(const FocusParams params, RESOLVED_TEXELS focus, __global const uchar* mask,
                        OUTPUT_TEXELS output) {
  const int row = get_global_id(1);
  const int first = get_global_id(0) * params.columns_per_item;
  if (first >= params.width || row >= params.height) return;

  const int y = params.top + row;
  const int end = params.left + min(first + params.columns_per_item, params.width);
  for (int x = params.left + first; x < end; x += kBlock) {
    const float4 weights = weights_of(&params, mask, x, y, end);
    if (all(weights >= 1.0f)) {
      store_output4(output, params.output, x, y, load_resolved4(focus, params.focus, x, y));
      continue;
    }
    lay_pixel(focus, output, &params, x, y, weights.s0);
    lay_pixel(focus, output, &params, x + 1, y, weights.s1);
    lay_pixel(focus, output, &params, x + 2, y, weights.s2);
    lay_pixel(focus, output, &params, x + 3, y, weights.s3);
  }
}
