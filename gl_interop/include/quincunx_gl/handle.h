// SPDX-License-Identifier: MIT
// Move-only owners of GL object names. In OpenGL ES a name is an object only once it was bound (gl_calls.h).
#pragma once

#include <epoxy/gl.h>

#include <utility>

#include "quincunx_gl/capabilities.h"

namespace quincunx::gl {

// `Traits` has create() -> GLuint and destroy(GLuint). The context must be current in both.
template <typename Traits>
class Handle {
 public:
  Handle() = default;  // owns nothing
  static Handle create() { return Handle(Traits::create()); }
  static Handle adopt(GLuint name) { return Handle(name); }

  ~Handle() { reset(); }
  Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    if (this != &other) {
      reset();
      name_ = std::exchange(other.name_, 0);
    }
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  GLuint get() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  explicit Handle(GLuint name) : name_(name) {}
  void reset() {
    if (name_ != 0) Traits::destroy(std::exchange(name_, 0));
  }

  GLuint name_ = 0;
};

struct Texture2DTraits {
  static GLuint create() {
    GLuint name = 0;
    capabilities().api == Api::kGl45 ? glCreateTextures(GL_TEXTURE_2D, 1, &name) : glGenTextures(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteTextures(1, &name); }
};
struct FramebufferTraits {
  static GLuint create() {
    GLuint name = 0;
    capabilities().api == Api::kGl45 ? glCreateFramebuffers(1, &name) : glGenFramebuffers(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteFramebuffers(1, &name); }
};
struct BufferTraits {
  static GLuint create() {
    GLuint name = 0;
    capabilities().api == Api::kGl45 ? glCreateBuffers(1, &name) : glGenBuffers(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteBuffers(1, &name); }
};
struct VertexArrayTraits {
  static GLuint create() {
    GLuint name = 0;
    capabilities().api == Api::kGl45 ? glCreateVertexArrays(1, &name) : glGenVertexArrays(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
};
struct TimeQueryTraits {
  static GLuint create() {
    GLuint name = 0;
    capabilities().api == Api::kGl45 ? glCreateQueries(GL_TIME_ELAPSED, 1, &name) : glGenQueries(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteQueries(1, &name); }
};
struct ProgramTraits {
  static GLuint create() { return glCreateProgram(); }
  static void destroy(GLuint name) { glDeleteProgram(name); }
};

using Texture = Handle<Texture2DTraits>;
using Framebuffer = Handle<FramebufferTraits>;
using Buffer = Handle<BufferTraits>;
using VertexArray = Handle<VertexArrayTraits>;
using TimeQuery = Handle<TimeQueryTraits>;
using Program = Handle<ProgramTraits>;

}  // namespace quincunx::gl
