// SPDX-License-Identifier: MIT
// TruthTargets: one sub-frame's target and the sum of all, in 32-bit float, at output extent.
#pragma once

#include <vector>

#include "quincunx/status.h"
#include "quincunx_gl/handle.h"
#include "quincunx_gl/render_targets.h"

namespace quincunx::scenes {

class TruthTargets {
 public:
  static Result<TruthTargets> create(Extent output);

  Extent extent() const { return frame_.extent(); }
  const gl::RenderTargets& frame() const { return frame_; }

  void clear();                     // the sum
  void add(float weight);           // weight * frame() to the sum
  std::vector<float> read() const;  // RGBA, top row first; waits for the GPU

 private:
  explicit TruthTargets(Extent output);

  gl::RenderTargets frame_;
  gl::Texture sum_;
  gl::Framebuffer sum_framebuffer_;
  gl::Program program_;
  gl::VertexArray nothing_;
};

}  // namespace quincunx::scenes
