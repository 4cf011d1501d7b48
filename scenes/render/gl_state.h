// SPDX-License-Identifier: MIT
// The fixed-function state of each part of a frame.
#pragma once

#include <glm/glm.hpp>

#include "quincunx/extent.h"
#include "quincunx_gl/render_targets.h"

namespace quincunx::scenes {

// Rows top-down, depth from 0 to 1, for the life of the guard; then GL's defaults for all that a frame
// changes.
class DrawState {
 public:
  DrawState();
  ~DrawState();
  DrawState(const DrawState&) = delete;
  DrawState& operator=(const DrawState&) = delete;
};

// Which triangles are seen from the front: those that run counter-clockwise, or with `mirrored` the others.
void set_winding(bool mirrored);

// Depth whole to infinity and the viewport's part of the reactive values to 0. Colour and velocity need no
// clear: surfaces and sky cover every pixel. Leaves the scissor on the viewport.
void clear_for_frame(const gl::RenderTargets& targets, Extent render);

// Makes the viewport of particles transparent black and unmarked. Leaves the scissor on it, and the stencil test off.
void clear_particles(const gl::RenderTargets& targets, Extent viewport);

// Gives a block of the colour target, `corner` its upper left pixel, one value in R, G and B, and alpha 1.
void fill_colour(const gl::RenderTargets& targets, glm::ivec2 corner, glm::ivec2 size, float value);

// From here on pixels with (x + y) % 2 == parity alone are drawn, where the targets have a checkerboard. Nothing writes
// the stencil, so a driver may test it before it shades.
void draw_checkerboard(int parity);

void set_opaque_state();      // writes colour, velocity, depth
void set_sky_state();         // colour and velocity where nothing was drawn
void set_depth_only_state();  // writes depth, whatever was there
void set_blended_state();     // blends premultiplied colour, accumulates reactive values

}  // namespace quincunx::scenes
