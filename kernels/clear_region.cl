// SPDX-License-Identifier: MIT
// clear_region: fills the top left rectangle of an image with one value: the partial clear.
//   params  in   rectangle; the value as bits of one texel (buffer) and as numbers (image)
//   output  out  any format of image.h
// Options: OUTPUT_STORAGE  BUFFER (default) | IMAGE
//          TEXEL_BYTES     of a buffer's texel: 8 (default) | 1 | 4 | 16
// Reference: tests/reference/clear_region.cpp
#ifndef OUTPUT_STORAGE
#define OUTPUT_STORAGE BUFFER
#endif
#ifndef TEXEL_BYTES
#define TEXEL_BYTES 8
#endif
#include "picture_params.h"
#include "texel.h"

#if OUTPUT_STORAGE == IMAGE
#define CLEARED_TEXELS write_only image2d_t
#elif OUTPUT_STORAGE != BUFFER
#error "OUTPUT_STORAGE must be BUFFER or IMAGE"
#elif TEXEL_BYTES == 1
#define CLEARED_TEXELS __global uchar*
#elif TEXEL_BYTES == 4
#define CLEARED_TEXELS __global uint*
#elif TEXEL_BYTES == 8
#define CLEARED_TEXELS __global uint2*
#elif TEXEL_BYTES == 16
#define CLEARED_TEXELS __global uint4*
#else
#error "TEXEL_BYTES must be 1, 4, 8 or 16"
#endif

__kernel void clear_region(const ClearParams params, CLEARED_TEXELS output) {
  const int y = get_global_id(1);
  const int first = get_global_id(0) * params.columns_per_item;
  if (first >= params.width || y >= params.height) return;

  const int end = min(first + params.columns_per_item, params.width);
#if OUTPUT_STORAGE == IMAGE
  const float4 texel = (float4)(params.value[0], params.value[1], params.value[2], params.value[3]);
  for (int x = first; x < end; ++x) write_imagef(output, (int2)(x, y), texel);
#else
#if TEXEL_BYTES == 1
  const uchar texel = (uchar)params.bits[0];
#elif TEXEL_BYTES == 4
  const uint texel = params.bits[0];
#elif TEXEL_BYTES == 8
  const uint2 texel = (uint2)(params.bits[0], params.bits[1]);
#else
  const uint4 texel = (uint4)(params.bits[0], params.bits[1], params.bits[2], params.bits[3]);
#endif
  for (int x = first; x < end; ++x) output[texel_index(params.output, x, y)] = texel;
#endif
}
