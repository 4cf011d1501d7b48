// SPDX-License-Identifier: MIT
// convert_inputs: converts one input of a frame from the caller's conventions to those of the kernels.
//   params  in   viewport, layouts, planes, motion of the jitter
//   given   in   the caller's image, viewport
//   made    out  the same kind of image, viewport
// Both may be images. A layout's offset and pitch count rows, so that they can be turned.
// Options: INPUT           DEPTH (default): reversed and infinite, from a distance or from any depth between planes
//                          VELOCITY: without the jitter, where it is not (0, 0)
//                          ROWS: every texel as it is; images only
//          SOURCE_STORAGE, VELOCITY_FORMAT as in texel.h
// Reference: tests/reference/convert_inputs.cpp
#define DEPTH 1
#define VELOCITY 2
#define ROWS 3
#ifndef INPUT
#define INPUT DEPTH
#endif
#if INPUT != DEPTH && INPUT != VELOCITY && INPUT != ROWS
#error "INPUT must be DEPTH, VELOCITY or ROWS"
#endif
#include "motion/velocity_params.h"
#include "texel.h"
#if SOURCE_STORAGE == IMAGE
#define GIVEN_TEXELS read_only image2d_t
#define MADE_TEXELS write_only image2d_t
#elif INPUT == DEPTH
#define GIVEN_TEXELS DEPTH_TEXELS
#define MADE_TEXELS __global float*
#elif INPUT == VELOCITY
#define GIVEN_TEXELS VELOCITY_TEXELS
#define MADE_TEXELS STORED_VELOCITY
#else
#error "INPUT ROWS needs SOURCE_STORAGE IMAGE: the rows of a buffer are turned by its layout"
#endif

#if INPUT == DEPTH
// What is farthest is infinitely far, and so is a distance that is none.
static inline float4 converted(float4 depth, const ConvertParams* params) {
  if (params->is_linear) return select((float4)(0.0f), fmin(params->near_plane / depth, 1.0f), depth > 0.0f);
  const float4 reversed = params->is_reversed ? depth : 1.0f - depth;
  return select(reversed + (1.0f - reversed) * params->near_by_far, (float4)(0.0f), reversed == 0.0f);
}

static inline void store_depths(MADE_TEXELS texels, TexelLayout layout, int x, int y, int end, float4 depth) {
#if SOURCE_STORAGE == IMAGE
  write_imagef(texels, (int2)(x, y), (float4)(depth.s0, 0.0f, 0.0f, 1.0f));
  if (x + 1 < end) write_imagef(texels, (int2)(x + 1, y), (float4)(depth.s1, 0.0f, 0.0f, 1.0f));
  if (x + 2 < end) write_imagef(texels, (int2)(x + 2, y), (float4)(depth.s2, 0.0f, 0.0f, 1.0f));
  if (x + 3 < end) write_imagef(texels, (int2)(x + 3, y), (float4)(depth.s3, 0.0f, 0.0f, 1.0f));
#else
  __global float* pixels = texels + texel_index(layout, x, y);
  if (x + 3 < end) {
    vstore4(depth, 0, pixels);
    return;
  }
  pixels[0] = depth.s0;
  if (x + 1 < end) pixels[1] = depth.s1;
  if (x + 2 < end) pixels[2] = depth.s2;
#endif
}
#elif INPUT == VELOCITY
static inline float8 converted(float8 velocity, const ConvertParams* params) {
  const float2 jitter = (float2)(params->jitter_x, params->jitter_y);
  const int8 is_drawn = velocity != 0.0f;  // a NaN is
  const int8 either = is_drawn | is_drawn.s10325476;
  return select(velocity, velocity - (float8)(jitter, jitter, jitter, jitter), either);
}
#endif

__kernel void convert_inputs(const ConvertParams params, GIVEN_TEXELS given, MADE_TEXELS made) {
  const int y = get_global_id(1);
  const int first = get_global_id(0) * params.columns_per_item;
  if (first >= params.width || y >= params.height) return;

  const int end = min(first + params.columns_per_item, params.width);
#if SOURCE_STORAGE == IMAGE
  const int from = row_index(params.given, y), to = row_index(params.made, y);
#else
  const int from = y, to = y;
#endif
#if INPUT == ROWS
  for (int x = first; x < end; ++x) write_imagef(made, (int2)(x, to), read_imagef(given, (int2)(x, from)));
#else
  for (int x = first; x < end; x += kBlock) {
#if INPUT == DEPTH
    const float4 depth = load_depth_block(given, params.given, x, from, params.width);
    store_depths(made, params.made, x, to, end, converted(depth, &params));
#else
    const float8 velocity = load_velocity_block(given, params.given, x, from, params.width);
    store_velocity4(made, params.made, x, to, end, converted(velocity, &params));
#endif
  }
#endif
}
