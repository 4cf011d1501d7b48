// SPDX-License-Identifier: MIT
#include "current_context.h"

#include <dlfcn.h>

#include <atomic>
#include <initializer_list>

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

}  // namespace quincunx::gl
