// SPDX-License-Identifier: MIT
// Copies by compute shaders: of texels to and from a buffer of the device's, and of depth, which OpenCL takes from a
// texture only with an extension, and OpenGL ES never reads.
#pragma once

#include <epoxy/gl.h>

#include <cstddef>

#include "frame_layout.h"
#include "quincunx_gl/handle.h"
#include "state_scope.h"

namespace quincunx::gl {

struct SamplerTraits {
  static GLuint create();  // takes texels as they are
  static void destroy(GLuint name) { glDeleteSamplers(1, &name); }
};

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

// Copies one immutable texture, which outlives this object. Desktop OpenGL alone. glReadPixels and glTextureSubImage2D
// do the same, but on NVIDIA's H100 they take 45 GB/s of 3 TB/s.
class TexelCopy {
 public:
  enum class Direction { kToBuffer, kToTexture };

  // `format`: the texture's, or R32F for a depth format, which is only read. Throws InteropError where the driver
  // refuses.
  TexelCopy(GLuint texture, PixelFormat format, bool is_depth, Direction direction);

  // Copies the top left `extent`; `offset` and `pitch` are bytes of the buffer, multiples of a texel's. Of R8 a row
  // ends with up to three texels more, and they are multiples of 4. Puts back the state.
  void run(Extent extent, GLuint buffer, std::size_t offset, std::size_t pitch, Before before) const;

 private:
  std::size_t word_bytes_;
  int word_texels_;
  GLenum access_;
  GLenum image_format_;  // GL_NONE: the texture is sampled
  Texture view_;         // the texels as whole numbers
  GLuint texture_;       // or the texture itself
  Program program_;
  Handle<SamplerTraits> sampler_;
};

}  // namespace quincunx::gl
