// SPDX-License-Identifier: MIT
// ParticleLayer: the depth that hides particles which are drawn into a viewport of their own.
#pragma once

#include "quincunx/status.h"
#include "quincunx_gl/handle.h"
#include "render/renderer.h"

namespace quincunx::scenes {

class ParticleLayer {
 public:
  static Result<ParticleLayer> create();

  // Makes the particles' viewport transparent black and gives it the frame's depth: of the samples that a texel covers,
  // the nearest one's and the farthest one's in turns, like the fields of a checkerboard, so that on both sides of an
  // edge there are texels of both surfaces. Leaves the framebuffer of the particles bound, its viewport set, and depth
  // state changed.
  void begin(const gl::RenderTargets& frame, const FrameView& view, const gl::RenderTargets& particles) const;

 private:
  gl::Program program_;
  gl::VertexArray nothing_;
};

}  // namespace quincunx::scenes
