// SPDX-License-Identifier: MIT
#include "window/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <spdlog/spdlog.h>
#include <cstdlib>

#include <string>
#include <utility>

namespace quincunx::scenes {
namespace {

// The error of the last call that failed. GLFW tells it by a call-back without a place for a pointer.
std::string& last_error() {
  static std::string text;
  return text;
}

void note_error(int, const char* text) {
  last_error() = text;
  spdlog::debug("window: {}", text);
}

Window& window_of(GLFWwindow* handle) {
  return *static_cast<Window*>(glfwGetWindowUserPointer(handle));
}

// Ends GLFW when a window could not be made after all.
Status give_up(const std::string& what) {
  Status status = Status::unsupported(fmt::format("{}: {}", what, last_error()));
  glfwTerminate();
  return status;
}

}  // namespace

Result<std::unique_ptr<Window>> Window::create(Extent size, const std::string& title, bool vsync,
                                               gl::Api api) {
  glfwSetErrorCallback(note_error);
  end_when_display_is_lost();
#ifdef GLFW_PLATFORM_X11
  // Wayland cannot be had without this folder, and its library would complain about that on its own.
  if (std::getenv("XDG_RUNTIME_DIR") == nullptr) glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
  if (glfwInit() != GLFW_TRUE) return give_up("no window could be opened");
  const bool desktop = api == gl::Api::kGl45;
  glfwWindowHint(GLFW_CLIENT_API, desktop ? GLFW_OPENGL_API : GLFW_OPENGL_ES_API);
  glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, desktop ? 4 : 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, desktop ? 5 : 1);
  if (desktop) glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  GLFWwindow* handle = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
  if (handle == nullptr) {
    return give_up(desktop ? "no window with OpenGL 4.5 core through EGL could be opened"
                           : "no window with OpenGL ES 3.1 through EGL could be opened");
  }
  glfwMakeContextCurrent(handle);
  glfwSwapInterval(vsync ? 1 : 0);
  auto window = std::unique_ptr<Window>(new Window(handle));
  window->listen();
  window->look();
  return window;
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::listen() {
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, [](GLFWwindow* handle, int key, int, int action, int modifiers) {
    if (action == GLFW_RELEASE) return;
    window_of(handle).keys_.push_back({key, (modifiers & GLFW_MOD_SHIFT) != 0});
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* handle, double, double y) {
    window_of(handle).pointer_.scrolled += y > 0 ? 1 : y < 0 ? -1 : 0;
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* handle, int button, int action, int) {
    if (button != GLFW_MOUSE_BUTTON_LEFT) return;
    window_of(handle).dragging_ = action == GLFW_PRESS;
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* handle, double x, double y) {
    Window& window = window_of(handle);
    int width = 1;
    int height = 1;
    glfwGetWindowSize(handle, &width, &height);
    const Extent pixels = window.framebuffer();
    const Vec2 now = {static_cast<float>(x) * static_cast<float>(pixels.width) / static_cast<float>(width),
                      static_cast<float>(y) * static_cast<float>(pixels.height) / static_cast<float>(height)};
    if (window.dragging_) {
      window.pointer_.dragged.x += now.x - window.pointer_.position.x;
      window.pointer_.dragged.y += now.y - window.pointer_.position.y;
    }
    window.pointer_.position = now;
  });
}

void Window::poll(double seconds) {
  if (seconds > 0) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
  look();
}

void Window::look() {
  glfwGetFramebufferSize(window_, &framebuffer_.width, &framebuffer_.height);
  minimised_ = glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE || framebuffer_.area() == 0;
}

std::vector<KeyPress> Window::take_keys() {
  return std::exchange(keys_, {});
}

PointerUse Window::take_pointer() {
  return std::exchange(pointer_, {.position = pointer_.position});
}

bool Window::closing() const {
  return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

void Window::resize(Extent size) {
  glfwSetWindowSize(window_, size.width, size.height);
}

void Window::minimise() {
  glfwIconifyWindow(window_);
}

void Window::restore() {
  glfwRestoreWindow(window_);
}

void Window::swap() {
  glfwSwapBuffers(window_);
}

}  // namespace quincunx::scenes
