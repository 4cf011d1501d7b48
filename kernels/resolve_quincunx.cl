// SPDX-License-Identifier: MIT
// resolve_quincunx: blend this frame with the previous one on the five-of-a-die pattern, in the seed's form.
//   c0, c1 = this and the previous frame, bilinear, each offset by the inverse of its jitter
//   f      = (1 - reactive) / (1 + K (|v0|^2 + |v1|^2)), v in pixels a frame;   out = (c0 + f c1) / (1 + f)
//
//   params             in   extents, layouts, velocity scales with sqrt(K) in them, camera motion
//   axes0, axes1       in   AxisTap of each output column, then row, for each frame's viewport and jitter
//   colour0, colour1   in   RGBA16F or RGBA32F, viewports of frame n and n-1, linear, premultiplied
//   motion0, motion1   in   WEIGHT 1: RG16F or RG32F velocity; WEIGHT 2: R32F depth; same viewports; the nearest sample
//   reactive0          in   R8 of frame n, the nearest sample; 0 trusts the previous frame, 1 ignores it
//   output             out  RGBA32F or RGBA16F, output extent
//   non_finite         out  non_finite[params.counter] grows by the pixels with NaN or infinite input of non-zero weight
// Options: WEIGHT    1 velocity target (default) | 2 velocity from depth and camera | 0 plain mean: nothing moves
//          REACTIVE  0 (default) | 1
//          SOURCE_STORAGE, SOURCE_FORMAT, VELOCITY_FORMAT, OUTPUT_FORMAT as in texel.h
// Where the previous frame or a velocity is not finite, f is 0: nothing survives into the next frame.
// Source: Binks, "Dynamic Resolution Rendering", 2012.   Reference: tests/reference/resolve_quincunx.cpp
#include "bilinear.h"

#ifndef WEIGHT
#define WEIGHT 1
#endif
#ifndef REACTIVE
#define REACTIVE 0
#endif
#if WEIGHT < 0 || WEIGHT > 2
#error "WEIGHT must be 0, 1 or 2"
#endif
#if REACTIVE < 0 || REACTIVE > 1
#error "REACTIVE must be 0 or 1"
#endif

#if WEIGHT == 2
#define MOTION_TEXELS DEPTH_TEXELS
#else
#define MOTION_TEXELS VELOCITY_TEXELS
#endif

#if WEIGHT == 2
// This position - previous position of what a texel shows, in uv of the viewport.
static inline float2 velocity_from_depth(const CameraVelocity* camera, float depth, int x, int y) {
  const float ndc_x = x * camera->step_x + camera->start_x;
  const float ndc_y = y * camera->step_y + camera->start_y;
  __private const float* m = camera->to_previous;
  const float previous_x = m[0] * ndc_x + m[4] * ndc_y + m[8] * depth + m[12];
  const float previous_y = m[1] * ndc_x + m[5] * ndc_y + m[9] * depth + m[13];
  const float previous_w = m[3] * ndc_x + m[7] * ndc_y + m[11] * depth + m[15];
  return (float2)(ndc_x - previous_x / previous_w, previous_y / previous_w - ndc_y) * 0.5f;
}
#endif

__kernel void resolve_quincunx(const ResolveParams params, __global const AxisTap* axes0,
                               __global const AxisTap* axes1, COLOUR_TEXELS colour0, COLOUR_TEXELS colour1,
#if WEIGHT != 0
                               MOTION_TEXELS motion0, MOTION_TEXELS motion1,
#endif
#if REACTIVE
                               REACTIVE_TEXELS reactive0,
#endif
                               OUTPUT_TEXELS output, __global uint* non_finite) {
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  if (x >= params.output_width || y >= params.output_height) return;

  const AxisTap column0 = axes0[x];
  const AxisTap row0 = axes0[params.output_width + y];
  const AxisTap column1 = axes1[x];
  const AxisTap row1 = axes1[params.output_width + y];
  bool non_finite0;
  bool non_finite1;
  const float4 c0 = sample_bilinear(colour0, params.frame0.colour, params.frame0.width, params.frame0.height, column0,
                                    row0, &non_finite0);
  const float4 c1 = sample_bilinear(colour1, params.frame1.colour, params.frame1.width, params.frame1.height, column1,
                                    row1, &non_finite1);

  float trust = 1.0f;
  float speed = 0.0f;  // K (|v0|^2 + |v1|^2)
#if REACTIVE
  trust -= load_reactive(reactive0, params.frame0.reactive, column0.nearest, row0.nearest);
#endif
#if WEIGHT != 0
#if WEIGHT == 1
  const float2 v0 = load_velocity(motion0, params.frame0.velocity, column0.nearest, row0.nearest);
  const float2 v1 = load_velocity(motion1, params.frame1.velocity, column1.nearest, row1.nearest);
  const float2 input0 = v0;
  const float2 input1 = v1;
#else
  const float2 input0 = load_depth(motion0, params.frame0.velocity, column0.nearest, row0.nearest);
  const float2 input1 = load_depth(motion1, params.frame1.velocity, column1.nearest, row1.nearest);
  const float2 v0 = velocity_from_depth(&params.camera0, input0.x, column0.nearest, row0.nearest);
  const float2 v1 = velocity_from_depth(&params.camera1, input1.x, column1.nearest, row1.nearest);
#endif
  const float2 p0 = v0 * (float2)(params.velocity0_scale_x, params.velocity0_scale_y);
  const float2 p1 = v1 * (float2)(params.velocity1_scale_x, params.velocity1_scale_y);
  speed = dot(p0, p0) + dot(p1, p1);
#endif
  // share = f / (1 + f), and so 1 - share = 1 / (1 + f).
  float share = trust / (1.0f + trust + speed);
#if WEIGHT != 0
  if (is_non_finite(speed)) {
    // Too fast for a float, or not finite to begin with: either way the previous frame has no weight.
    share = 0.0f;
    non_finite0 |= any_non_finite2(input0) || any_non_finite2(input1);
  }
#endif
  if (non_finite1) share = 0.0f;
  if (non_finite0 || non_finite1) atomic_inc(non_finite + params.counter);
  store_output(output, params.output, x, y, c0 * (1.0f - share) + c1 * share);
}
