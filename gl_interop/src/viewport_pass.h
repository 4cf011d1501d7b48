// SPDX-License-Identifier: MIT
// Passes of GL that draw over the whole viewport.
#pragma once

#include <epoxy/gl.h>

#include "quincunx/extent.h"
#include "quincunx_gl/handle.h"

namespace quincunx::gl {

// Makes a program whose three vertices, drawn as triangles without any attribute, cover the viewport. GLSL ES 3.10,
// which OpenGL 4.5 takes as well. `name` stands in the message. A context must be current. Throws InteropError if it
// does not link.
Program covering_program(const char* fragment_source, const char* name);

// Reads depth where glReadPixels takes colour only, as in OpenGL ES: a pass draws it into R32F first.
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
