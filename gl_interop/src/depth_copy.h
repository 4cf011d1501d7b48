// SPDX-License-Identifier: MIT
// Depth as R32F: OpenCL takes depth textures only with an extension, and OpenGL ES reads none.
#pragma once

#include <epoxy/gl.h>

#include <string>

#include "quincunx/advanced/extent.h"
#include "quincunx_gl/handle.h"
#include "state_scope.h"

namespace quincunx::gl {

struct SamplerTraits {
  static GLuint create();  // takes texels as they are
  static void destroy(GLuint name) { glDeleteSamplers(1, &name); }
};

// Returns the program of one compute shader. Throws InteropError where the driver refuses it.
Program compute_program(const std::string& text);

// Copies depth textures by a compute shader.
class DepthCopy {
 public:
  DepthCopy() = default;      // copies nothing
  static DepthCopy create();  // throws InteropError where the driver refuses the shader

  // Copies the top left `render` of `depth`, of any depth format, to an immutable R32F texture. Puts back the state.
  void copy(GLuint depth, GLuint to, Extent render, Before before) const;

 private:
  Program program_;
  Handle<SamplerTraits> sampler_;
};

// Reads depth where glReadPixels takes colour only.
class DepthReader {
 public:
  DepthReader() = default;  // reads nothing
  // For viewports of at most this extent. Throws std::runtime_error where the driver refuses what it needs.
  explicit DepthReader(Extent target);

  // Reads the top left `render` of the depth texture as floats, within a PackScope of the caller's.
  void read(GLuint depth, Extent render, void* pixels, Before before) const;

 private:
  Texture copy_;
  Framebuffer framebuffer_;
  DepthCopy to_copy_;
};

}  // namespace quincunx::gl
