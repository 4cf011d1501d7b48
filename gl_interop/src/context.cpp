// SPDX-License-Identifier: MIT
#include "quincunx_gl/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "quincunx/advanced/log.h"
#include "quincunx_gl/capabilities.h"
#include "state_scope.h"

namespace quincunx::gl {
namespace {

// The least version that is taken, and what EGL calls it.
struct ApiTraits {
  const char* name;
  EGLenum api;
  EGLint renderable;
  EGLint major, minor;
};

const ApiTraits& traits_of(Api api) {
  static constexpr ApiTraits kDesktop = {"OpenGL 4.5 core", EGL_OPENGL_API, EGL_OPENGL_BIT, 4, 5};
  static constexpr ApiTraits kEs = {"OpenGL ES 3.1", EGL_OPENGL_ES_API, EGL_OPENGL_ES3_BIT, 3, 1};
  return api == Api::kGl45 ? kDesktop : kEs;
}

bool lists(const char* extensions, std::string_view wanted) {
  std::string_view rest = extensions != nullptr ? extensions : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == wanted) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

std::string egl_error(const char* call) {
  return fmt::format("{} failed with EGL error 0x{:04x}", call, static_cast<unsigned>(eglGetError()));
}

// eglGetPlatformDisplay returns one display for every call with the same arguments, and eglTerminate ends it
// for all of them, so contexts of this process share a count for each display.
class DisplayUse {
 public:
  DisplayUse() = default;
  ~DisplayUse() { release(); }
  DisplayUse(DisplayUse&& other) noexcept : display_(std::exchange(other.display_, EGL_NO_DISPLAY)) {}
  DisplayUse& operator=(DisplayUse&& other) noexcept {
    std::swap(display_, other.display_);
    return *this;
  }
  DisplayUse(const DisplayUse&) = delete;
  DisplayUse& operator=(const DisplayUse&) = delete;

  static DisplayUse initialise(EGLDisplay display) {
    const std::lock_guard lock(mutex());
    DisplayUse use;
    if (eglInitialize(display, nullptr, nullptr) != EGL_TRUE) return use;
    ++counts()[display];
    use.display_ = display;
    return use;
  }

  EGLDisplay get() const { return display_; }
  explicit operator bool() const { return display_ != EGL_NO_DISPLAY; }

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  static std::map<EGLDisplay, int>& counts() {
    static std::map<EGLDisplay, int> instance;
    return instance;
  }
  void release() {
    const EGLDisplay display = std::exchange(display_, EGL_NO_DISPLAY);
    if (display == EGL_NO_DISPLAY) return;
    const std::lock_guard lock(mutex());
    if (--counts()[display] > 0) return;
    counts().erase(display);
    if (eglTerminate(display) != EGL_TRUE) log_line(LogLevel::kWarning, egl_error("eglTerminate"));
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
};

void APIENTRY log_gl_error(GLenum, GLenum type, GLuint id, GLenum, GLsizei, const GLchar* message,
                           const void*) {
  if (type == GL_DEBUG_TYPE_ERROR)
    log_line(LogLevel::kError, fmt::format("OpenGL error {}: {}", id, message));
}

std::string gl_string(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text != nullptr ? text : "";
}

bool is_software(const std::string& renderer) {
  constexpr std::array kNames = {"llvmpipe", "softpipe", "swrast", "Software Rasterizer", "SwiftShader"};
  return std::any_of(kNames.begin(), kNames.end(),
                     [&](const char* name) { return renderer.find(name) != std::string::npos; });
}

}  // namespace

struct Context::Impl {
  DisplayUse display;
  void* context = nullptr;
  bool borrowed = false;   // the context is its maker's
  void* handle = nullptr;  // the display
  ContextInfo info;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (context == nullptr || borrowed) return;
    eglBindAPI(traits_of(info.api).api);
    if (eglGetCurrentContext() == context &&
        eglMakeCurrent(display.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT) != EGL_TRUE) {
      log_line(LogLevel::kWarning, egl_error("eglMakeCurrent"));
    }
    if (eglDestroyContext(display.get(), context) != EGL_TRUE) {
      log_line(LogLevel::kWarning, egl_error("eglDestroyContext"));
    }
  }

  Status make_current() const {
    // Not by eglMakeCurrent: that would take the window's surface away.
    if (borrowed) {
      if (current_context().context == context) return {};
      return Status::invalid("the window's OpenGL context is not current on this thread");
    }
    if (eglMakeCurrent(display.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) {
      return Status::device(egl_error("eglMakeCurrent without a surface"));
    }
    return {};
  }

  // Opens `native` of `platform_enum`; "" when that worked, else what went wrong.
  std::string open(EGLenum platform_enum, void* native, Platform platform, Api wanted);

  // Takes the context that is current; "" when that worked, else what went wrong.
  std::string borrow_current();

 private:
  std::string make_context();
  std::string describe_context();
};

std::string Context::Impl::make_context() {
  const ApiTraits& api = traits_of(info.api);
  const char* extensions = eglQueryString(display.get(), EGL_EXTENSIONS);
  if (!lists(extensions, "EGL_KHR_surfaceless_context")) return "it lacks EGL_KHR_surfaceless_context";

  EGLConfig config = nullptr;  // EGL_NO_CONFIG_KHR
  if (!lists(extensions, "EGL_KHR_no_config_context")) {
    const std::array<EGLint, 5> wanted = {EGL_RENDERABLE_TYPE, api.renderable, EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLint count = 0;
    if (eglChooseConfig(display.get(), wanted.data(), &config, 1, &count) != EGL_TRUE || count < 1) {
      return fmt::format("it has no EGL config for {}", api.name);
    }
  }
#ifdef NDEBUG
  constexpr EGLint kDebug = EGL_FALSE;
#else
  constexpr EGLint kDebug = EGL_TRUE;
#endif
  std::vector<EGLint> attributes = {EGL_CONTEXT_MAJOR_VERSION, api.major,
                                    EGL_CONTEXT_MINOR_VERSION, api.minor,
                                    EGL_CONTEXT_OPENGL_DEBUG,  kDebug};
  if (info.api == Api::kGl45) {
    attributes.insert(attributes.end(),
                      {EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT});
  }
  attributes.push_back(EGL_NONE);
  context = eglCreateContext(display.get(), config, EGL_NO_CONTEXT, attributes.data());
  if (context == nullptr) return egl_error(fmt::format("eglCreateContext for {}", api.name).c_str());
  return {};
}

std::string Context::Impl::describe_context() {
  if (Status status = make_current(); !status.ok()) return status.message();
  const Capabilities& can = renewed_capabilities();
  info.api = can.api;
  info.vendor = gl_string(GL_VENDOR);
  info.renderer = gl_string(GL_RENDERER);
  info.version = gl_string(GL_VERSION);
  info.software = is_software(info.renderer);
  const ApiTraits& api = traits_of(info.api);
  if (can.version < 10 * api.major + api.minor) {
    return fmt::format("'{}' offers version {}.{} where {} is needed", info.renderer, can.version / 10,
                       can.version % 10, api.name);
  }
  if (!can.missing.empty()) {
    return fmt::format("'{}' offers OpenGL ES {}.{} without {}; 3.2 has it", info.renderer, can.version / 10,
                       can.version % 10, can.missing);
  }
  if (borrowed) return {};
  if (info.api == Api::kGl45 || can.version >= 32 || epoxy_has_gl_extension("GL_KHR_debug")) {
    glEnable(GL_DEBUG_OUTPUT);
    glDebugMessageCallback(log_gl_error, nullptr);
  }
  return {};
}

std::string Context::Impl::open(EGLenum platform_enum, void* native, Platform platform, Api wanted) {
  info.platform = platform;
  info.api = wanted;
  const auto get_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (get_display == nullptr) return "EGL lacks eglGetPlatformDisplayEXT";
  handle = get_display(platform_enum, native, nullptr);
  if (handle == EGL_NO_DISPLAY) return egl_error("eglGetPlatformDisplayEXT");
  display = DisplayUse::initialise(handle);
  if (!display) return egl_error("eglInitialize");
  if (eglBindAPI(traits_of(info.api).api) != EGL_TRUE) return egl_error("eglBindAPI");
  if (std::string error = make_context(); !error.empty()) return error;
  return describe_context();
}

std::string Context::Impl::borrow_current() {
  const CurrentContext current = current_context();
  info.platform = Platform::kCurrent;
  info.system = current.system;
  context = current.context;
  handle = current.display;
  borrowed = true;
  if (context == nullptr)
    return "no EGL or GLX context is current on this thread; make the window's current first";
  return describe_context();
}

namespace {

std::vector<EGLDeviceEXT> egl_devices(std::string* error) {
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (!lists(extensions, "EGL_EXT_platform_device") ||
      !(lists(extensions, "EGL_EXT_device_enumeration") || lists(extensions, "EGL_EXT_device_base"))) {
    *error = "EGL lacks EGL_EXT_platform_device or EGL_EXT_device_enumeration";
    return {};
  }
  const auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  EGLint count = 0;
  if (query == nullptr || query(0, nullptr, &count) != EGL_TRUE) {
    *error = egl_error("eglQueryDevicesEXT");
    return {};
  }
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
  if (count > 0 && query(count, devices.data(), &count) != EGL_TRUE) count = 0;
  devices.resize(static_cast<std::size_t>(count));
  if (devices.empty()) *error = "EGL lists no device";
  return devices;
}

void note_failure(std::string* tried, const std::string& what, const std::string& error) {
  *tried += fmt::format("{}{}: {}", tried->empty() ? "" : "; ", what, error);
}

}  // namespace

const char* name_of(Platform platform) {
  switch (platform) {
    case Platform::kAuto:
      return "auto";
    case Platform::kSurfaceless:
      return "surfaceless";
    case Platform::kDevice:
      return "device";
    case Platform::kCurrent:
      return "window";
  }
  return "unknown";
}

Result<Context> Context::create(Platform platform, Api api) {
  if (platform == Platform::kCurrent) {
    auto impl = std::make_unique<Impl>();
    if (const std::string error = impl->borrow_current(); !error.empty()) {
      return Status::unsupported(fmt::format("the current OpenGL context cannot be used: {}", error));
    }
    return Context(std::move(impl));
  }
  std::string tried;
  std::unique_ptr<Impl> software;  // the first software device, kept in case nothing better comes

  if (platform != Platform::kSurfaceless) {
    std::string error;
    const std::vector<EGLDeviceEXT> devices = egl_devices(&error);
    if (!error.empty()) note_failure(&tried, "device platform", error);
    for (std::size_t i = 0; i < devices.size(); ++i) {
      auto impl = std::make_unique<Impl>();
      error = impl->open(EGL_PLATFORM_DEVICE_EXT, devices[i], Platform::kDevice, api);
      if (!error.empty()) {
        note_failure(&tried, fmt::format("device platform, device {}", i), error);
      } else if (!impl->info.software) {
        return Context(std::move(impl));
      } else if (!software) {
        software = std::move(impl);
      }
    }
  }
  if (platform != Platform::kDevice) {
    auto impl = std::make_unique<Impl>();
    std::string error = "EGL lacks EGL_MESA_platform_surfaceless";
    if (lists(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_MESA_platform_surfaceless")) {
      error = impl->open(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, Platform::kSurfaceless, api);
    }
    if (error.empty()) return Context(std::move(impl));
    note_failure(&tried, "surfaceless platform", error);
  }
  if (software) {
    if (Status status = software->make_current(); !status.ok()) return status;
    return Context(std::move(software));
  }
  return Status::unsupported(
      fmt::format("no {} context could be made without a window ({}); a GPU driver with EGL or, "
                  "for the CPU, "
                  "the Debian packages libegl1 and libgl1-mesa-dri provide one",
                  traits_of(api).name, tried));
}

Context::Context(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Context::~Context() = default;
Context::Context(Context&&) noexcept = default;
Context& Context::operator=(Context&&) noexcept = default;

const ContextInfo& Context::info() const {
  return impl_->info;
}
void* Context::display() const {
  return impl_->handle;
}
void* Context::context() const {
  return impl_->context;
}
Status Context::make_current() {
  return impl_->make_current();
}

}  // namespace quincunx::gl
