// SPDX-License-Identifier: MIT
// OpenGL's state that the bridge changes, saved, and put back at the end of a scope: callers are in the middle of a
// frame of theirs. Each scope asks for the values that it changes, and for no others. And the context that is current.
#pragma once

#include <epoxy/gl.h>

#include <array>

#include "quincunx_gl/context.h"

namespace quincunx::gl {

// The OpenGL context that is current on this thread, whoever made it.
struct CurrentContext {
  WindowSystem system = WindowSystem::kEgl;
  void* context = nullptr;  // null: none
  void* display = nullptr;

  friend bool operator==(const CurrentContext&, const CurrentContext&) = default;
};

CurrentContext current_context();

// Where a scope has the values from that it puts back.
enum class Before {
  kAsked,    // from OpenGL
  kDefault,  // they are those of a new context: nothing is asked (BridgeSettings::restores_state)
};

// Inside, reads of pixels are plain copies: rows follow each other without a gap, to client memory, unclamped. Puts
// back the parameters of the pixel store that matter for two dimensions, the bindings of the pixel buffer and of the
// framebuffer that is read, and whether reads are clamped.
class PackScope {
 public:
  explicit PackScope(Before before = Before::kAsked);
  ~PackScope();
  PackScope(const PackScope&) = delete;
  PackScope& operator=(const PackScope&) = delete;

 private:
  std::array<GLint, 5> store_ = {4, 0, 0, 0, 0};
  GLint buffer_ = 0;
  GLint framebuffer_ = 0;
  GLint clamp_ = GL_FIXED_ONLY;
};

// The same for writes of pixels.
class UnpackScope {
 public:
  explicit UnpackScope(Before before = Before::kAsked);
  ~UnpackScope();
  UnpackScope(const UnpackScope&) = delete;
  UnpackScope& operator=(const UnpackScope&) = delete;

 private:
  std::array<GLint, 5> store_ = {4, 0, 0, 0, 0};
  GLint buffer_ = 0;
};

// Binds an object to a target that `query` asks for, and puts back what was bound.
class BindingScope {
 public:
  using Bind = void (*)(GLenum target, GLuint name);
  BindingScope(Bind bind, GLenum target, GLenum query, GLuint name) : bind_(bind), target_(target) {
    glGetIntegerv(query, &before_);
    bind_(target_, name);
  }
  ~BindingScope() { bind_(target_, static_cast<GLuint>(before_)); }
  BindingScope(const BindingScope&) = delete;
  BindingScope& operator=(const BindingScope&) = delete;

  static BindingScope texture(GLuint name) {
    return {bind_texture, GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D, name};
  }
  static BindingScope buffer(GLuint name) {
    return {bind_buffer, GL_COPY_WRITE_BUFFER, GL_COPY_WRITE_BUFFER_BINDING, name};
  }
  static BindingScope drawn(GLuint name) {
    return {bind_framebuffer, GL_DRAW_FRAMEBUFFER, GL_DRAW_FRAMEBUFFER_BINDING, name};
  }
  static BindingScope read(GLuint name) {
    return {bind_framebuffer, GL_READ_FRAMEBUFFER, GL_READ_FRAMEBUFFER_BINDING, name};
  }

  static void bind_texture(GLenum target, GLuint name) { glBindTexture(target, name); }
  static void bind_buffer(GLenum target, GLuint name) { glBindBuffer(target, name); }
  static void bind_framebuffer(GLenum target, GLuint name) { glBindFramebuffer(target, name); }

 private:
  Bind bind_;
  GLenum target_;
  GLint before_ = 0;
};

// Puts back what a compute shader needs: the program, texture and sampler of unit 0, the active unit, image unit 0.
class ComputeScope {
 public:
  explicit ComputeScope(Before before = Before::kAsked);
  ~ComputeScope();
  ComputeScope(const ComputeScope&) = delete;
  ComputeScope& operator=(const ComputeScope&) = delete;

 private:
  GLint program_ = 0;
  GLint active_unit_ = GL_TEXTURE0;
  GLint texture_ = 0;
  GLint sampler_ = 0;
  GLboolean layered_ = GL_FALSE;
  std::array<GLint, 5> image_ = {0, 0, 0, GL_READ_ONLY, GL_R8};  // name, level, layer, access, format
};

// Puts back the first storage buffer, and the one that is bound without an index.
class StorageScope {
 public:
  explicit StorageScope(Before before = Before::kAsked);
  ~StorageScope();
  StorageScope(const StorageScope&) = delete;
  StorageScope& operator=(const StorageScope&) = delete;

 private:
  GLint generic_ = 0;
  GLint buffer_ = 0;
  GLint64 start_ = 0;
  GLint64 size_ = 0;  // 0: the whole of it
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

// Inside, a triangle reaches every pixel of a framebuffer of one colour, and is added to it. Puts back the program, the
// vertex array, the framebuffer that is drawn, the viewport, blending of draw buffer 0, culling, the polygon mode, and
// what ClearScope does.
class DrawScope {
 public:
  DrawScope(GLuint framebuffer, GLuint program, GLuint vertices, GLint side);
  ~DrawScope();
  DrawScope(const DrawScope&) = delete;
  DrawScope& operator=(const DrawScope&) = delete;

 private:
  ClearScope masks_;
  BindingScope framebuffer_;
  GLint program_ = 0;
  GLint vertices_ = 0;
  std::array<GLfloat, 4> viewport_ = {};
  GLboolean blends_ = GL_FALSE;
  GLboolean culls_ = GL_FALSE;
  std::array<GLint, 6> blending_ = {};  // in the order of kBlending
  std::array<GLint, 2> polygons_ = {};
};

// Keeps the caller's error: what OpenGL says inside is of the calls inside. At the end the caller's is raised again.
class ErrorScope {
 public:
  ErrorScope() : before_(take()) {}
  ~ErrorScope();
  ErrorScope(const ErrorScope&) = delete;
  ErrorScope& operator=(const ErrorScope&) = delete;

  // Returns the first error since the last call, GL_NO_ERROR where there is none.
  static GLenum take();

 private:
  GLenum before_;
};

// Throws InteropError "glImportMemoryFdEXT failed with OpenGL error 0x0501" where there was one since the last call.
void check_gl(const char* what);

}  // namespace quincunx::gl
