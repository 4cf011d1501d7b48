// SPDX-License-Identifier: MIT
// overlay_particles: lays particles that were drawn into a viewport of their own over the frame that they belong to.
// Colour, coverage and reactive value of the particles at a pixel are the mean of the four particle texels around its
// centre, each weighted by its bilinear weight times
//   clamp(1 - (g - h) / (.05 + h), 0, 1)     g  the gap |z' - z| / max(z', z) of the texel's depth z' and the pixel's z
//                                            h  the least gap of the four
// so that no texel counts that shows a surface other than the pixel's where one shows the pixel's. Depth is reversed:
// a gap is the relative difference of distances. Then
//   colour    c + (1 - a) b      c, a  the particles' colour and coverage, b the frame's colour
//   reactive  r + (1 - r) q      r  the particles', q the frame's
//
//   params             in   extents, layouts
//   bare_colour        in   RGBA16F or RGBA32F, viewport, linear, premultiplied, without particles
//   depth              in   R32F, viewport, reversed and infinite
//   bare_reactive      in   REACTIVE 1: R8, viewport
//   particle_colour    in   as bare_colour, the particles' viewport, alpha: coverage
//   particle_depth     in   R32F, the particles' viewport: of the surface that hides what is behind it there
//   particle_reactive  in   REACTIVE 1: R8, the particles' viewport
//   colour             out  as bare_colour, viewport
//   reactive           out  REACTIVE 1: R8, viewport
// Options: REACTIVE  0 (default) | 1
//          SOURCE_STORAGE, SOURCE_FORMAT as in texel.h, not SRGB8
// Colour that is not finite is passed on bit for bit; particle texels that are not finite do not count. Where all four
// hold nothing, every bit is kept.
// Sources: Cantlay, "High-Speed, Off-Screen Particles", GPU Gems 3, 2007; Jansen and Bavoil, "Fast Rendering of
// Opacity-Mapped Particles using DirectX 11 Tessellation and Mixed Resolutions", 2011 (nearest-depth upsampling); Kopf,
// Cohen, Lischinski and Uyttendaele, "Joint Bilateral Upsampling", 2007.
// Reference: tests/reference/overlay_particles.cpp
#ifndef REACTIVE
#define REACTIVE 0
#endif
#if REACTIVE < 0 || REACTIVE > 1
#error "REACTIVE must be 0 or 1"
#endif

#include "bits.h"
#include "picture_params.h"
#include "stored_frame.h"

#define SAME_SURFACE 0.05f  // the relative gap of depths from which a texel shows another surface
#define LEAST_DEPTH 1e-30f  // two infinitely far surfaces, of depth 0, are alike
#define NO_TEXEL 4.0f       // the gap of a texel whose colour is not finite: so large that its weight is 0 beside any

// On one axis: the texels on both sides of a pixel's centre, one and the same where it lies on a texel's or beyond all.
typedef struct ParticleTexels {
  int low, high;
  float fraction;  // part of the way from low to high
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

// Particles at a pixel; nothing where `count` is false.
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

__kernel void overlay_particles(const OverlayParams params, COLOUR_TEXELS bare_colour, DEPTH_TEXELS depth,
                                REACTIVE_TEXELS bare_reactive, COLOUR_TEXELS particle_colour,
                                DEPTH_TEXELS particle_depth, REACTIVE_TEXELS particle_reactive, STORED_COLOUR colour,
                                STORED_REACTIVE reactive) {
  const int y = get_global_id(1);
  const int first = get_global_id(0) * params.columns_per_item;
  if (first >= params.width || y >= params.height) return;

  const int end = min(first + params.columns_per_item, params.width);
  const ParticleTexels rows = particle_texels(y, params.height, params.particle_height);
  for (int block = first; block < end; block += kParticleBlock) {
    const int stop = min(block + kParticleBlock, end);
    const int low = particle_texels(block, params.width, params.particle_width).low;
    const int high = particle_texels(stop - 1, params.width, params.particle_width).high;
    const bool none = has_no_particles(&params, particle_colour, particle_reactive, rows, low, high);
    for (int x = block; x < stop; ++x) {
      Particles over = NO_PARTICLES;
      if (!none) {
        const ParticleTexels columns = particle_texels(x, params.width, params.particle_width);
        over = particles_at(&params, particle_colour, particle_depth, particle_reactive,
                            load_depth(depth, params.depth, x, y), columns, rows);
      }
      const float4 below = load_colour(bare_colour, params.bare_colour, x, y);
      if (over.count && !any_non_finite4(below)) {
        const float through = clamp(1.0f - over.colour.w, 0.0f, 1.0f);
        store_colour(colour, params.colour, x, y, over.colour + below * through);
      } else {
        copy_colour(bare_colour, params.bare_colour, colour, params.colour, x, y);
      }
#if REACTIVE
      if (over.count) {
        const float before = load_reactive(bare_reactive, params.bare_reactive, x, y);
        store_reactive(reactive, params.reactive, x, y, over.reactive + before * (1.0f - over.reactive));
      } else {
        copy_reactive(bare_reactive, params.bare_reactive, x, y, reactive, params.reactive, x, y);
      }
#endif
    }
  }
}
