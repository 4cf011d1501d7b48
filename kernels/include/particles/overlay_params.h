// SPDX-License-Identifier: MIT
// The struct that host and overlay_particles share, as in params.h.
#pragma once

#include "params.h"

#ifdef __cplusplus
namespace quincunx {
#endif

// Runs of this many neighbouring pixels of a row are copied at once where no particle is.
enum { kParticleBlock = 8 };

typedef struct OverlayParams {
  int width;  // the viewport of the frame
  int height;
  int particle_width;  // that of the particles
  int particle_height;
  int columns_per_item;  // a multiple of kParticleBlock
  TexelLayout bare_colour, bare_reactive, depth;
  TexelLayout particle_colour, particle_reactive, particle_depth;
  TexelLayout colour, reactive;
} OverlayParams;
QUINCUNX_CHECK_SIZE(OverlayParams, 20 + 8 * 8);

#ifdef __cplusplus
}  // namespace quincunx
#endif
