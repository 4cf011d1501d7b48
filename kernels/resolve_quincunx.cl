// SPDX-License-Identifier: MIT
// resolve_quincunx: blends this frame with the previous one; their samples together form the pattern of the five on a
// die.
//   c0, c1 = this and the previous frame, each sampled at the pixel's centre less its jitter
//   f      = (1 - reactive0) (1 - reactive1) / (1 + K (|v0|^2 + |v1|^2)), v in render pixels a frame
//   out    = (c0 + f c1) / (1 + f)
//
//   params             in   extents, layouts, velocity scales with sqrt(K) in them
//   axes0, axes1       in   AxisTap of each output column, then row, for each frame's viewport and jitter
//   colour0, colour1   in   RGBA16F or RGBA32F, viewports of frame n and n-1, linear, premultiplied
//   velocity0, 1       in   RG16F or RG32F, the same viewports; the nearest sample; not read where WEIGHT is 0
//   reactive0, 1       in   REACTIVE 1: R8, the nearest sample of each frame; 0: frames may be mixed, 1: they may not
//   output             out  RGBA32F or RGBA16F, output extent
//   non_finite         out  non_finite[params.counter] grows by the pixels with NaN or infinite input that counts
// Options: SAMPLING  BILINEAR (default) | POINT: the nearest sample
//          WEIGHT    1 by the speed of both frames (default) | 0 plain mean
//          REACTIVE  0 (default) | 1
//          SOURCE_STORAGE, SOURCE_FORMAT, VELOCITY_FORMAT, OUTPUT_FORMAT as in texel.h
// Where the previous frame or a velocity is not finite, f is 0: nothing survives into the next frame.
// Source: Binks, "Dynamic Resolution Rendering", 2012.   Reference: tests/reference/resolve_quincunx.cpp
#include "bilinear.h"
#include "bits.h"
#include "resolve_params.h"

// Not zero, so that a misspelt option is an error.
#define BILINEAR 1
#define POINT 2

#ifndef SAMPLING
#define SAMPLING BILINEAR
#endif
#ifndef WEIGHT
#define WEIGHT 1
#endif
#ifndef REACTIVE
#define REACTIVE 0
#endif
#if SAMPLING != BILINEAR && SAMPLING != POINT
#error "SAMPLING must be BILINEAR or POINT"
#endif
#if WEIGHT < 0 || WEIGHT > 1
#error "WEIGHT must be 0 or 1"
#endif
#if REACTIVE < 0 || REACTIVE > 1
#error "REACTIVE must be 0 or 1"
#endif

static inline int4 nearest_of(__global const AxisTap* columns) {
  if (LANES == 1) return columns[0].nearest;
  return (int4)(columns[0].nearest, columns[1].nearest, columns[2].nearest, columns[3].nearest);
}

// Into *mean the pixels of one frame. `careful`, a constant, chooses the way; the slow one sets bit i of *non_finite
// where pixel i met NaN or Inf.
__attribute__((always_inline)) static inline void sample_frame(bool careful, COLOUR_TEXELS colour, SourceFrame frame,
                                                               __global const AxisTap* columns, AxisTap row,
                                                               FourPixels* mean, uint* non_finite) {
#if SAMPLING == BILINEAR
  sample_four(careful, colour, frame.colour, frame.width, frame.height, columns, row, mean, non_finite);
#else
  mean->p0 = load_colour(colour, frame.colour, columns[0].nearest, row.nearest);
  if (LANES == 8) {
    mean->p1 = load_colour(colour, frame.colour, columns[1].nearest, row.nearest);
    mean->p2 = load_colour(colour, frame.colour, columns[2].nearest, row.nearest);
    mean->p3 = load_colour(colour, frame.colour, columns[3].nearest, row.nearest);
  }
  if (careful) *non_finite = sanitise_four(mean);
#endif
}

#if WEIGHT == 1
// Zero where it is not finite.
static inline float8 settled_velocity(float8 velocity) {
  const int8 bits = as_int8(velocity);
  return as_float8(select(bits, (int8)(0), (bits & 0x7fffffff) >= NON_FINITE_BITS));
}

static inline int4 non_finite_velocity(float8 velocity) {
  return non_finite_lanes(velocity.even) | non_finite_lanes(velocity.odd);
}

// K |v|^2 of four pixels from their velocities.
static inline float4 speed_of(float8 velocity, float scale_x, float scale_y) {
  const float8 scaled = velocity * (float8)(scale_x, scale_y, scale_x, scale_y, scale_x, scale_y, scale_x, scale_y);
  const float8 squared = scaled * scaled;
  return squared.even + squared.odd;
}
#endif

static inline FourPixels blend(FourPixels c0, FourPixels c1, float4 share) {
  FourPixels mean;
  mean.p0 = c0.p0 * (1.0f - share.s0) + c1.p0 * share.s0;
  mean.p1 = c0.p1 * (1.0f - share.s1) + c1.p1 * share.s1;
  mean.p2 = c0.p2 * (1.0f - share.s2) + c1.p2 * share.s2;
  mean.p3 = c0.p3 * (1.0f - share.s3) + c1.p3 * share.s3;
  return mean;
}

// An item's pixels of row y. The fast way (`careful` false) returns the largest magnitudes it met; the slow one
// is right for NaN and Inf as well and adds the pixels that met them to *met.
__attribute__((always_inline)) static inline int4 resolve_row(
    bool careful, const ResolveParams* params, ItemColumns item, int y, __global const AxisTap* axes0,
    __global const AxisTap* axes1, COLOUR_TEXELS colour0, COLOUR_TEXELS colour1, VELOCITY_TEXELS velocity0,
    VELOCITY_TEXELS velocity1, REACTIVE_TEXELS reactive0, REACTIVE_TEXELS reactive1, OUTPUT_TEXELS output, uint* met) {
  const SourceFrame frame0 = params->frame0;
  const SourceFrame frame1 = params->frame1;
  const AxisTap row0 = axes0[params->row_axis + y];
  const AxisTap row1 = axes1[params->row_axis + y];
  int4 largest = 0;
  for (int x = item.first; x < item.end; x += item.step) {
    const int count = pixels_from(item, x);
    uint bits0;
    uint bits1;
    FourPixels c0;
    FourPixels c1;
    sample_frame(careful, colour0, frame0, axes0 + x, row0, &c0, &bits0);
    sample_frame(careful, colour1, frame1, axes1 + x, row1, &c1, &bits1);

    float4 trust = 1.0f;
    float4 speed = 0.0f;  // K (|v0|^2 + |v1|^2)
#if WEIGHT != 0 || REACTIVE
    const int4 nearest0 = nearest_of(axes0 + x);
    const int4 nearest1 = nearest_of(axes1 + x);
#endif
#if REACTIVE
    trust -= load_reactive4(reactive0, frame0.reactive, nearest0, row0.nearest);
    trust *= 1.0f - load_reactive4(reactive1, frame1.reactive, nearest1, row1.nearest);
#endif
#if WEIGHT != 0
    float8 input0 = load_velocity4(velocity0, frame0.velocity, nearest0, row0.nearest);
    float8 input1 = load_velocity4(velocity1, frame1.velocity, nearest1, row1.nearest);
    const int4 lost = non_finite_velocity(input0) | non_finite_velocity(input1);
    if (careful) {
      // Before any arithmetic: the bits of the input decide, not what a compiler makes of NaN.
      input0 = settled_velocity(input0);
      input1 = settled_velocity(input1);
    }
    speed = speed_of(input0, params->velocity0_scale_x, params->velocity0_scale_y) +
            speed_of(input1, params->velocity1_scale_x, params->velocity1_scale_y);
#endif
    // share = f / (1 + f), and so 1 - share = 1 / (1 + f).
    float4 share = trust / (1.0f + trust + speed);
    if (careful) {
#if WEIGHT != 0
      // Too fast for a float, or not finite to begin with: either way the previous frame has no weight.
      share = select(share, 0.0f, lost | non_finite_lanes(speed));
      bits0 |= lane_bits(lost);
#endif
      share = select(share, 0.0f, (int4)((int)bits1) << (int4)(31, 30, 29, 28));
      *met += count_bits(bits0 | bits1, count);
    }
    const FourPixels mean = blend(c0, c1, share);
    largest = larger_magnitude(largest_of(largest, mean), speed);
    store_four(output, params->output, x, y, x + count, mean);
  }
  return largest;
}

__kernel void resolve_quincunx(const ResolveParams params, __global const AxisTap* axes0,
                               __global const AxisTap* axes1, COLOUR_TEXELS colour0, COLOUR_TEXELS colour1,
                               VELOCITY_TEXELS velocity0, VELOCITY_TEXELS velocity1, REACTIVE_TEXELS reactive0,
                               REACTIVE_TEXELS reactive1, OUTPUT_TEXELS output, __global uint* non_finite) {
  const int y = get_global_id(1);
  const ItemColumns item = columns_of_item(params.columns_per_item, params.output_width, kBlock);
  if (item.first >= item.end || y >= params.output_height) return;

  uint met = 0;
  if (min(params.frame0.width, params.frame1.width) > 1) {
    const int4 largest = resolve_row(false, &params, item, y, axes0, axes1, colour0, colour1, velocity0,
                                     velocity1, reactive0, reactive1, output, &met);
    if (!any_reached_infinity(largest)) return;
  }
  resolve_row(true, &params, item, y, axes0, axes1, colour0, colour1, velocity0, velocity1, reactive0, reactive1,
              output, &met);
  if (met) atomic_add(non_finite + params.counter, met);
}
