// SPDX-License-Identifier: MIT
// RespecifiedTargets: the render targets of a frame under names that stay while their size changes (glTexImage2D), to
// be measured beside those that are made anew and those that are kept.
#pragma once

#include <array>

#include "quincunx/extent.h"
#include "quincunx_gl/handle.h"

namespace quincunx::bench {

class RespecifiedTargets {
 public:
  RespecifiedTargets();

  // Throws std::runtime_error where the framebuffer is not complete.
  void resize(Extent extent);
  void clear() const;

 private:
  gl::Framebuffer framebuffer_;
  std::array<gl::Texture, 4> textures_;
};

}  // namespace quincunx::bench
