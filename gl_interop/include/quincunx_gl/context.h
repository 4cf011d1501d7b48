// SPDX-License-Identifier: MIT
// Context: an OpenGL 4.5 or OpenGL ES 3.1 context, either one of its own without a window (EGL), or the one that is
// current, for example a window's (EGL or GLX).
#pragma once

#include <memory>
#include <string>

#include "quincunx/advanced/export.h"
#include "quincunx/status.h"
#include "quincunx_gl/capabilities.h"

namespace quincunx::gl {

enum class Platform {
  kAuto,  // device where it is a GPU, else surfaceless
  kSurfaceless,
  kDevice,
  kCurrent,  // no new context: the one that is current on this thread, for example a window's
};

enum class WindowSystem { kEgl, kGlx };  // maker of a context

QUINCUNX_API const char* name_of(Platform platform);  // "surfaceless"

struct ContextInfo {
  Platform platform = Platform::kAuto;  // the one in use
  WindowSystem system = WindowSystem::kEgl;
  std::string vendor;    // GL_VENDOR
  std::string renderer;  // GL_RENDERER
  std::string version;   // GL_VERSION
  Api api = Api::kGl45;
  bool software = false;  // llvmpipe, softpipe, swrast
};

// Owns display connection and context, except for kCurrent: that context stays its owner's, who keeps it alive and
// current longer than this object. Move-only. The context is current on the thread that made it, and every GL call of
// this library happens on the thread where it is current. The caller destroys it after all GL objects. Debug output of
// the driver (errors, not chatter) of its own context goes to the log.
class QUINCUNX_API Context {
 public:
  // Makes a context, or takes the current one, whose API then counts. Errors: kUnsupported with each attempt and its
  // failure; for kCurrent also where no context is current.
  static Result<Context> create(Platform platform = Platform::kAuto, Api api = Api::kGl45);

  ~Context();
  Context(Context&&) noexcept;
  Context& operator=(Context&&) noexcept;

  const ContextInfo& info() const;
  void* display() const;  // EGLDisplay, or Display* of GLX
  void* context() const;  // EGLContext, or GLXContext
  Status make_current();

 private:
  struct QUINCUNX_HIDDEN Impl;
  explicit Context(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace quincunx::gl
