// SPDX-License-Identifier: MIT
// overlay_particles: particles that were drawn into a viewport of their own, laid over the frame they belong to.
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

#include "particles/particle_taps.h"

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
