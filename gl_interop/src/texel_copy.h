// SPDX-License-Identifier: MIT
// TexelCopy: texels between textures and a buffer of the device's, by compute shaders. glReadPixels and
// glTextureSubImage2D do the same, but on NVIDIA's H100 they take 45 GB/s of 3 TB/s.
#pragma once

#include <epoxy/gl.h>

#include <cstddef>

#include "depth_copy.h"
#include "frame_layout.h"
#include "quincunx_gl/handle.h"
#include "state_scope.h"

namespace quincunx::gl {

// Copies one immutable texture, which outlives this object. Desktop OpenGL alone.
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
