// SPDX-License-Identifier: MIT
#include "state_scope.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <atomic>
#include <initializer_list>

#include "cl_handle.h"
#include "quincunx/advanced/log.h"
#include "quincunx_gl/capabilities.h"
#include "quincunx_gl/handle.h"

namespace quincunx::gl {
namespace {

// A function of a window system. Looked for only in libraries that are loaded already, as that of a current context is:
// libepoxy would load them, and ends the process where one is missing.
class Function {
 public:
  constexpr Function(const char* name, std::initializer_list<const char*> libraries)
      : name_(name), libraries_(libraries) {}

  void* operator()() {
    Pointer found = found_.load(std::memory_order_relaxed);
    for (const char* const* library = libraries_.begin(); found == nullptr && library != libraries_.end();
         ++library) {
      // Never closed: the pointer is kept.
      if (void* const handle = dlopen(*library, RTLD_LAZY | RTLD_NOLOAD))
        found = reinterpret_cast<Pointer>(dlsym(handle, name_));
    }
    found_.store(found, std::memory_order_relaxed);
    return found != nullptr ? found() : nullptr;
  }

 private:
  using Pointer = void* (*)();
  const char* name_;
  std::initializer_list<const char*> libraries_;
  std::atomic<Pointer> found_ = nullptr;
};

// Alignment first, which is 1 inside, where all others are 0; the last is of desktop OpenGL alone.
using PixelStore = std::array<GLenum, 5>;
constexpr PixelStore kPack = {GL_PACK_ALIGNMENT, GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS,
                              GL_PACK_SWAP_BYTES};
constexpr PixelStore kUnpack = {GL_UNPACK_ALIGNMENT, GL_UNPACK_ROW_LENGTH, GL_UNPACK_SKIP_ROWS,
                                GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SWAP_BYTES};

constexpr std::array<GLenum, 5> kImage = {GL_IMAGE_BINDING_NAME, GL_IMAGE_BINDING_LEVEL,
                                          GL_IMAGE_BINDING_LAYER, GL_IMAGE_BINDING_ACCESS,
                                          GL_IMAGE_BINDING_FORMAT};
constexpr std::array<GLenum, 6> kBlending = {GL_BLEND_SRC_RGB,      GL_BLEND_DST_RGB,
                                             GL_BLEND_SRC_ALPHA,    GL_BLEND_DST_ALPHA,
                                             GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA};

bool is_desktop() {
  return capabilities().api == Api::kGl45;
}

std::size_t count_of(const PixelStore& names) {
  return is_desktop() ? names.size() : names.size() - 1;
}

void begin_plain(const PixelStore& names, std::array<GLint, 5>& values, Before before) {
  for (std::size_t i = 0; i < count_of(names); ++i) {
    if (before == Before::kAsked) glGetIntegerv(names[i], &values[i]);
    glPixelStorei(names[i], i == 0 ? 1 : 0);
  }
}

void put_back(const PixelStore& names, const std::array<GLint, 5>& values) {
  for (std::size_t i = 0; i < count_of(names); ++i)
    glPixelStorei(names[i], values[i]);
}

void set_enabled(GLenum capability, bool on) {
  on ? glEnable(capability) : glDisable(capability);
}

// Sets the scissor of the first viewport alone where there are several: the calls without an index change all of them.
void set_scissor(bool on, const std::array<GLint, 4>& box) {
  if (is_desktop()) {
    on ? glEnablei(GL_SCISSOR_TEST, 0) : glDisablei(GL_SCISSOR_TEST, 0);
    glScissorIndexed(0, box[0], box[1], box[2], box[3]);
  } else {
    set_enabled(GL_SCISSOR_TEST, on);
    glScissor(box[0], box[1], box[2], box[3]);
  }
}

// The first viewport alone, too.
void set_viewport(const std::array<GLfloat, 4>& place) {
  if (is_desktop()) {
    glViewportIndexedfv(0, place.data());
  } else {
    glViewport(static_cast<GLint>(place[0]), static_cast<GLint>(place[1]), static_cast<GLsizei>(place[2]),
               static_cast<GLsizei>(place[3]));
  }
}

void set_blending(bool on, const std::array<GLint, 6>& values) {
  std::array<GLenum, 6> names = {};
  for (std::size_t i = 0; i < names.size(); ++i)
    names[i] = static_cast<GLenum>(values[i]);
  on ? glEnablei(GL_BLEND, 0) : glDisablei(GL_BLEND, 0);
  glBlendFuncSeparatei(0, names[0], names[1], names[2], names[3]);
  glBlendEquationSeparatei(0, names[4], names[5]);
}

}  // namespace

CurrentContext current_context() {
  static constexpr std::initializer_list<const char*> kEgl = {"libEGL.so.1"};
  static constexpr std::initializer_list<const char*> kGlx = {"libGLX.so.0", "libGL.so.1"};
  static Function egl_context("eglGetCurrentContext", kEgl);
  static Function egl_display("eglGetCurrentDisplay", kEgl);
  static Function glx_context("glXGetCurrentContext", kGlx);
  static Function glx_display("glXGetCurrentDisplay", kGlx);
  if (void* const context = egl_context()) return {WindowSystem::kEgl, context, egl_display()};
  if (void* const context = glx_context()) return {WindowSystem::kGlx, context, glx_display()};
  return {};
}

PackScope::PackScope(Before before) {
  begin_plain(kPack, store_, before);
  if (before == Before::kAsked) {
    glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &buffer_);
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &framebuffer_);
    if (is_desktop()) glGetIntegerv(GL_CLAMP_READ_COLOR, &clamp_);
  }
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  if (is_desktop()) glClampColor(GL_CLAMP_READ_COLOR, GL_FALSE);
}

PackScope::~PackScope() {
  put_back(kPack, store_);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(buffer_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(framebuffer_));
  if (is_desktop()) glClampColor(GL_CLAMP_READ_COLOR, static_cast<GLenum>(clamp_));
}

UnpackScope::UnpackScope(Before before) {
  begin_plain(kUnpack, store_, before);
  if (before == Before::kAsked) glGetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &buffer_);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

UnpackScope::~UnpackScope() {
  put_back(kUnpack, store_);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(buffer_));
}

ComputeScope::ComputeScope(Before before) {
  const bool asks = before == Before::kAsked;
  if (asks) {
    glGetIntegerv(GL_CURRENT_PROGRAM, &program_);
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active_unit_);
  }
  glActiveTexture(GL_TEXTURE0);
  if (!asks) {
    if (!is_desktop()) image_[4] = GL_R32UI;  // the initial format there, where R8 is none
    return;
  }
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &texture_);
  glGetIntegerv(GL_SAMPLER_BINDING, &sampler_);
  for (std::size_t i = 0; i < kImage.size(); ++i)
    glGetIntegeri_v(kImage[i], 0, &image_[i]);
  glGetBooleani_v(GL_IMAGE_BINDING_LAYERED, 0, &layered_);
}

ComputeScope::~ComputeScope() {
  glBindImageTexture(0, static_cast<GLuint>(image_[0]), image_[1], layered_, image_[2],
                     static_cast<GLenum>(image_[3]), static_cast<GLenum>(image_[4]));
  glBindSampler(0, static_cast<GLuint>(sampler_));
  glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(texture_));
  glActiveTexture(static_cast<GLenum>(active_unit_));
  glUseProgram(static_cast<GLuint>(program_));
}

StorageScope::StorageScope(Before before) {
  if (before != Before::kAsked) return;
  glGetIntegerv(GL_SHADER_STORAGE_BUFFER_BINDING, &generic_);
  glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, 0, &buffer_);
  glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_START, 0, &start_);
  glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_SIZE, 0, &size_);
}

StorageScope::~StorageScope() {
  if (size_ == 0) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLuint>(buffer_));
  } else {
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLuint>(buffer_),
                      static_cast<GLintptr>(start_), static_cast<GLsizeiptr>(size_));
  }
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(generic_));
}

ClearScope::ClearScope() {
  for (GLuint i = 0; i < colour_.size(); ++i) {
    glGetBooleani_v(GL_COLOR_WRITEMASK, i, colour_[i].data());
    glColorMaski(i, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  }
  glGetBooleanv(GL_DEPTH_WRITEMASK, &depth_);
  glDepthMask(GL_TRUE);
  discards_ = glIsEnabled(GL_RASTERIZER_DISCARD);
  glDisable(GL_RASTERIZER_DISCARD);
  scissored_ = glIsEnabled(GL_SCISSOR_TEST);
  glGetIntegerv(GL_SCISSOR_BOX, box_.data());
  set_scissor(false, box_);
}

ClearScope::~ClearScope() {
  for (GLuint i = 0; i < colour_.size(); ++i)
    glColorMaski(i, colour_[i][0], colour_[i][1], colour_[i][2], colour_[i][3]);
  glDepthMask(depth_);
  if (discards_ == GL_TRUE) glEnable(GL_RASTERIZER_DISCARD);
  set_scissor(scissored_ == GL_TRUE, box_);
}

void ClearScope::scissor(GLint width, GLint height) const {
  set_scissor(true, {0, 0, width, height});
}

DrawScope::DrawScope(GLuint framebuffer, GLuint program, GLuint vertices, GLint side)
    : framebuffer_(BindingScope::drawn(framebuffer)) {
  glGetIntegerv(GL_CURRENT_PROGRAM, &program_);
  glUseProgram(program);
  glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &vertices_);
  glBindVertexArray(vertices);
  glGetFloatv(GL_VIEWPORT, viewport_.data());
  set_viewport({0, 0, static_cast<GLfloat>(side), static_cast<GLfloat>(side)});
  blends_ = glIsEnabledi(GL_BLEND, 0);
  for (std::size_t i = 0; i < kBlending.size(); ++i)
    glGetIntegeri_v(kBlending[i], 0, &blending_[i]);
  set_blending(true, {GL_ONE, GL_ONE, GL_ONE, GL_ONE, GL_FUNC_ADD, GL_FUNC_ADD});
  culls_ = glIsEnabled(GL_CULL_FACE);
  glDisable(GL_CULL_FACE);
  if (!is_desktop()) return;
  glGetIntegerv(GL_POLYGON_MODE, polygons_.data());
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

DrawScope::~DrawScope() {
  if (is_desktop()) glPolygonMode(GL_FRONT_AND_BACK, static_cast<GLenum>(polygons_[0]));
  set_enabled(GL_CULL_FACE, culls_ == GL_TRUE);
  set_blending(blends_ == GL_TRUE, blending_);
  set_viewport(viewport_);
  glBindVertexArray(static_cast<GLuint>(vertices_));
  glUseProgram(static_cast<GLuint>(program_));
}

GLenum ErrorScope::take() {
  const GLenum first = glGetError();
  // More than one only where a driver keeps several; a lost context says so for ever.
  for (int i = 0; i < 8 && glGetError() != GL_NO_ERROR; ++i) {
  }
  return first;
}

void check_gl(const char* what) {
  if (const GLenum error = ErrorScope::take(); error != GL_NO_ERROR)
    throw InteropError(fmt::format("{} failed with OpenGL error 0x{:04x}", what, error));
}

ErrorScope::~ErrorScope() {
  take();
  switch (before_) {
    case GL_NO_ERROR:
      return;
    case GL_INVALID_ENUM:
      glEnable(GL_NONE);
      return;
    case GL_INVALID_VALUE:
      glViewport(0, 0, -1, -1);
      return;
    case GL_INVALID_OPERATION: {
      const Program unlinked = Program::create();
      glUseProgram(unlinked.get());
      return;
    }
    case GL_INVALID_FRAMEBUFFER_OPERATION: {
      const Framebuffer empty = Framebuffer::create();
      const BindingScope read = BindingScope::read(empty.get());
      std::array<GLubyte, 4> pixel = {};
      glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
      return;
    }
    default:
      log_line(LogLevel::kError,
               fmt::format("OpenGL had the error 0x{:04x} before a call of the bridge", before_));
  }
}

}  // namespace quincunx::gl
