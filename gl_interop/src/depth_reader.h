// SPDX-License-Identifier: MIT
// DepthReader: reads depth where glReadPixels takes colour only, as in OpenGL ES: a pass draws it into R32F first.
#pragma once

#include <epoxy/gl.h>

#include "quincunx/extent.h"
#include "quincunx_gl/handle.h"

namespace quincunx::gl {

class DepthReader {
 public:
  DepthReader() = default;  // reads nothing
  // For depth textures of this extent. Throws std::runtime_error where the driver takes no such target.
  explicit DepthReader(Extent target);

  // Reads the top left `render` of the depth texture as floats, with the pack state and pixel buffer that are set.
  // Leaves no program, vertex array and framebuffer bound, texture unit 0 empty, and changes the viewport.
  void read(GLuint depth, Extent render, void* pixels) const;

 private:
  Texture copy_;
  Framebuffer framebuffer_;
  Program program_;
  VertexArray nothing_;
};

}  // namespace quincunx::gl
