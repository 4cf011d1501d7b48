// SPDX-License-Identifier: MIT
// sharpen: each channel moves away from the mean of its four neighbours, as far as the range of all five allows.
//   params  in   extents, layouts, sharpness in [0, 1]
//   source  in   RGBA32F or RGBA16F, output extent, linear, premultiplied; a buffer. NaN counts as 0, +-Inf as +-65504
//   output  out  as source, alpha unchanged; another buffer
//   exposure  in  Exposure of this frame: c is exposed light
// Options: SOURCE_FORMAT  HALF (default) | FLOAT   of source; OUTPUT_FORMAT is the same
// With c the pixel, m the mean of left, right, above and below, low and high the range of the five:
//   out = clamp(c + sharpness * (1 + |c|) / (1 + max(-low, high)) * (c - m), low, high)
// Beyond the picture its outermost pixels repeat.
// Source: AMD FidelityFX Contrast Adaptive Sharpening, 2019, and RCAS of FSR 1, 2021: a cross whose weight gives way.
// Reference: tests/reference/sharpen.cpp
#include "bits.h"
#include "picture_params.h"
#include "texel.h"

#if SOURCE_FORMAT != OUTPUT_FORMAT
#error "SOURCE_FORMAT and OUTPUT_FORMAT must be the same"
#endif

// Four neighbours of a row, and what is beside each of them.
typedef struct Cross {
  float16 centre, left, right, above, below;
} Cross;

static inline float4 load_careful(RESOLVED_TEXELS source, const SharpenParams* params, int x, int y) {
  return sanitise4(load_resolved(source, params->source, clamp(x, 0, params->width - 1), y));
}

// Any four neighbours of a row, of any values.
static inline float16 load_careful4(RESOLVED_TEXELS source, const SharpenParams* params, int x, int y) {
  return (float16)(load_careful(source, params, x, y), load_careful(source, params, x + 1, y),
                   load_careful(source, params, x + 2, y), load_careful(source, params, x + 3, y));
}

static inline Cross load_careful_cross(RESOLVED_TEXELS source, const SharpenParams* params, int x, int y) {
  const int above = max(y - 1, 0), below = min(y + 1, params->height - 1);
  const Cross cross = {load_careful4(source, params, x, y), load_careful4(source, params, x - 1, y),
                       load_careful4(source, params, x + 1, y), load_careful4(source, params, x, above),
                       load_careful4(source, params, x, below)};
  return cross;
}

// From the mean of the neighbours to the pixel: not finite where any of the five is not.
static inline float16 contrast_of(Cross cross) {
  return cross.centre - (0.25f * cross.left + 0.25f * cross.right + (0.25f * cross.above + 0.25f * cross.below));
}

// min() and max(), not fmin() and fmax(): on a CPU those of NaN, which does not count here, cost more than the rest.
// `one`: 1 of exposed light, in scene light.
static inline float16 sharpened(Cross cross, float16 contrast, float sharpness, float one) {
  const float16 low = min(min(min(cross.left, cross.right), min(cross.above, cross.below)), cross.centre);
  const float16 high = max(max(max(cross.left, cross.right), max(cross.above, cross.below)), cross.centre);
  const float16 slope = (one + fabs(cross.centre)) / (one + max(-low, high));
  const float16 moved = min(max(cross.centre + sharpness * slope * contrast, low), high);
  const int4 alpha = (int4)(0, 0, 0, -1);
  return select(moved, cross.centre, (int16)(alpha, alpha, alpha, alpha));
}

static inline void sharpen_careful(RESOLVED_TEXELS source, OUTPUT_TEXELS output, const SharpenParams* params,
                                   float one, int x, int y, int end) {
  const Cross cross = load_careful_cross(source, params, x, y);
  const float16 colour = sharpened(cross, contrast_of(cross), params->sharpness, one);
  const FourPixels pixels = {colour.s0123, colour.s4567, colour.s89ab, colour.scdef};
  store_four(output, params->output, x, y, end, pixels);
}

__kernel void sharpen(const SharpenParams params, RESOLVED_TEXELS source, OUTPUT_TEXELS output,
                      __global const Exposure* exposure) {
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(params.columns_per_item, params.width, kBlock);
  if (item.first >= item.end || y >= params.height) return;

  const float one = exposure->inverse;
  int x = item.first;
#if LANES == 8
  const int above = max(y - 1, 0), below = min(y + 1, params.height - 1);
  const TexelLayout layout = params.source;
  int16 largest = 0;
  if (x == 0) {
    sharpen_careful(source, output, &params, one, x, y, item.end);
    x += kBlock;
  }
  for (; x + kBlock <= min(item.end, params.width - 1); x += kBlock) {
    const Cross cross = {load_resolved4(source, layout, x, y), load_resolved4(source, layout, x - 1, y),
                         load_resolved4(source, layout, x + 1, y), load_resolved4(source, layout, x, above),
                         load_resolved4(source, layout, x, below)};
    const float16 contrast = contrast_of(cross);
    largest = max(largest, as_int16(contrast) & 0x7fffffff);
    store_output4(output, params.output, x, y, sharpened(cross, contrast, params.sharpness, one));
  }
  const int8 largest8 = max(largest.lo, largest.hi);
  if (any_reached_infinity(max(largest8.lo, largest8.hi))) x = item.first;
#endif

  // The rest of the row or, which is rare, all of it once more. With LANES=1 all of it.
  for (; x < item.end; x += item.step)
    sharpen_careful(source, output, &params, one, x, y, x + pixels_from(item, x));
}
