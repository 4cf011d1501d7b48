// SPDX-License-Identifier: MIT
// OpenGL's state that the bridge changes, saved, and put back at the end of a scope: callers are in the middle of a
// frame of theirs.
#pragma once

#include <epoxy/gl.h>

#include <array>

namespace quincunx::gl {

// Inside, transfers of pixels are plain copies: no pixel buffer is bound, rows follow each other without a gap. Puts
// back pixel store parameters, the bindings of pixel and copy buffers and of framebuffers, and whether reads are
// clamped.
class TransferScope {
 public:
  TransferScope();
  ~TransferScope();
  TransferScope(const TransferScope&) = delete;
  TransferScope& operator=(const TransferScope&) = delete;

 private:
  std::array<GLint, 16> pixel_store_ = {};
  std::array<GLint, 5> bindings_ = {};
  GLint clamp_read_ = 0;
};

// Puts back what a compute shader needs: the program, texture and sampler of unit 0, the active unit, image unit 0.
class ComputeScope {
 public:
  ComputeScope();
  ~ComputeScope();
  ComputeScope(const ComputeScope&) = delete;
  ComputeScope& operator=(const ComputeScope&) = delete;

 private:
  GLint program_ = 0;
  GLint active_unit_ = 0;
  GLint texture_ = 0;
  GLint sampler_ = 0;
  GLboolean layered_ = GL_FALSE;
  std::array<GLint, 5> image_ = {};  // name, level, layer, access, format
};

// Inside, clears reach every value of draw buffers 0 to 2 and depth, in the rectangle that scissor() gives. Puts back
// masks, scissor and rasterizer discard.
class ClearScope {
 public:
  ClearScope();
  ~ClearScope();
  ClearScope(const ClearScope&) = delete;
  ClearScope& operator=(const ClearScope&) = delete;

  void scissor(GLint width, GLint height) const;  // from (0, 0)

 private:
  using Mask = std::array<GLboolean, 4>;
  std::array<Mask, 3> colour_ = {};
  GLboolean depth_ = GL_TRUE;
  GLboolean scissored_ = GL_FALSE;
  GLboolean discards_ = GL_FALSE;
  std::array<GLint, 4> box_ = {};
};

}  // namespace quincunx::gl
