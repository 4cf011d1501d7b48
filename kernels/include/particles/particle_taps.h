// SPDX-License-Identifier: MIT
// For overlay_particles: the four particle texels around a pixel and what each counts there.
#pragma once

#include "particles/overlay_params.h"
#include "stored_frame.h"

#define SAME_SURFACE 0.05f  // the relative gap of depths from which a texel shows another surface
#define LEAST_DEPTH 1e-30f  // two infinitely far surfaces, of depth 0, are alike
#define NO_TEXEL 4.0f       // the gap of a texel whose colour is not finite: so large that its weight is 0 beside any

// On one axis: the texels on both sides of a pixel's centre, one and the same where it lies on a texel's or beyond all.
typedef struct ParticleTexels {
  int low, high;
  float fraction;  // of the way from low to high
} ParticleTexels;

// In whole numbers, which extents of up to 32768 do not overflow: the fraction alone is rounded.
static inline ParticleTexels particle_texels(int pixel, int pixels, int texels) {
  const int along = (2 * pixel + 1) * texels - pixels, step = 2 * pixels;
  const int whole = along < 0 ? -1 : along / step;
  const int rest = along - whole * step;
  ParticleTexels found;
  found.low = clamp(whole, 0, texels - 1);
  found.high = clamp(whole + (rest > 0), 0, texels - 1);
  found.fraction = (float)rest / (float)step;
  return found;
}

// The relative gap between a surface's depth and those of four texels; 1 where one of the two is no number.
static inline float4 depth_gaps(float own, float4 depths) {
  const float4 larger = max(max(depths, (float4)(own)), (float4)(LEAST_DEPTH));
  const float4 gaps = fabs(depths - own) / larger;
  return select((float4)(1.0f), gaps, gaps <= 1.0f);
}

// Their weights in the mean, before they are divided by `total`, which is 0 where none of them may count.
typedef struct ParticleWeights {
  float4 each;
  float total;
} ParticleWeights;

static inline float sum4(float4 value) {
  return (value.s0 + value.s1) + (value.s2 + value.s3);
}

// By bilinear weight and by how near each gap comes to the least of the four; where even that is large, none shows the
// pixel's surface, and all count. Where nothing is left, since the texel of the least gap has no bilinear weight, the
// first one of the least gap alone.
static inline ParticleWeights particle_weights(float4 gaps, ParticleTexels columns, ParticleTexels rows) {
  const float right = columns.fraction, left = 1.0f - right, below = rows.fraction, above = 1.0f - below;
  const float least = min(min(gaps.s0, gaps.s1), min(gaps.s2, gaps.s3));
  ParticleWeights weights;
  weights.each = (float4)(left * above, right * above, left * below, right * below) *
                 clamp(1.0f - (gaps - least) / (SAME_SURFACE + least), 0.0f, 1.0f);
  weights.total = sum4(weights.each);
  if (least >= NO_TEXEL) {
    weights.total = 0.0f;
  } else if (weights.total <= 0.0f) {
    const bool first = gaps.s0 == least, second = !first && gaps.s1 == least;
    const bool third = !first && !second && gaps.s2 == least;
    weights.each = (float4)(first, second, third, !first && !second && !third);
    weights.total = 1.0f;
  }
  return weights;
}

// Whether a run of pixels has nothing of particles: neither colour nor reactive value in the texels around it.
static inline bool has_no_particles(const OverlayParams* params, COLOUR_TEXELS colour, REACTIVE_TEXELS reactive,
                                    ParticleTexels rows, int low, int high) {
  int4 bits = (int4)(0);
  for (int x = low; x <= high; ++x) {
    bits |= as_int4(load_colour(colour, params->particle_colour, x, rows.low));
    bits |= as_int4(load_colour(colour, params->particle_colour, x, rows.high));
#if REACTIVE
    bits.x |= as_int(load_reactive(reactive, params->particle_reactive, x, rows.low));
    bits.x |= as_int(load_reactive(reactive, params->particle_reactive, x, rows.high));
#endif
  }
  return !any((bits & 0x7fffffff) != 0);
}

// What the particles are at a pixel; nothing where `count` is false.
typedef struct Particles {
  float4 colour;
  float reactive;
  bool count;
} Particles;
#define NO_PARTICLES {(float4)(0.0f), 0.0f, false}

// A texel's colour, or none of it.
static inline float4 finite_or_none(float4 colour, float* gap) {
  if (!any_non_finite4(colour)) return colour;
  *gap = NO_TEXEL;
  return (float4)(0.0f);
}

static inline Particles particles_at(const OverlayParams* params, COLOUR_TEXELS colour, DEPTH_TEXELS depth,
                                     REACTIVE_TEXELS reactive, float own_depth, ParticleTexels columns,
                                     ParticleTexels rows) {
  const TexelLayout colours = params->particle_colour, depths = params->particle_depth;
  const float4 gaps = depth_gaps(own_depth, (float4)(load_depth(depth, depths, columns.low, rows.low),
                                                     load_depth(depth, depths, columns.high, rows.low),
                                                     load_depth(depth, depths, columns.low, rows.high),
                                                     load_depth(depth, depths, columns.high, rows.high)));
  float gap0 = gaps.s0, gap1 = gaps.s1, gap2 = gaps.s2, gap3 = gaps.s3;
  const float4 c0 = finite_or_none(load_colour(colour, colours, columns.low, rows.low), &gap0);
  const float4 c1 = finite_or_none(load_colour(colour, colours, columns.high, rows.low), &gap1);
  const float4 c2 = finite_or_none(load_colour(colour, colours, columns.low, rows.high), &gap2);
  const float4 c3 = finite_or_none(load_colour(colour, colours, columns.high, rows.high), &gap3);
  const ParticleWeights weights = particle_weights((float4)(gap0, gap1, gap2, gap3), columns, rows);
  Particles found = NO_PARTICLES;
  found.count = weights.total > 0.0f;
  if (!found.count) return found;
  const float4 each = weights.each / weights.total;
  found.colour = (c0 * each.s0 + c1 * each.s1) + (c2 * each.s2 + c3 * each.s3);
#if REACTIVE
  const TexelLayout marks = params->particle_reactive;
  found.reactive = sum4(each * (float4)(load_reactive(reactive, marks, columns.low, rows.low),
                                        load_reactive(reactive, marks, columns.high, rows.low),
                                        load_reactive(reactive, marks, columns.low, rows.high),
                                        load_reactive(reactive, marks, columns.high, rows.high)));
#endif
  return found;
}
