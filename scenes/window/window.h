// SPDX-License-Identifier: MIT
// Window: a window with an OpenGL 4.5 core or OpenGL ES 3.1 context made through EGL (GLFW). One a process; main
// thread only.
//
// When an X11 display goes away, any call may end the program, with exit status 1 and one sentence in the
// log: X11's library leaves no other way.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "quincunx/advanced/extent.h"
#include "quincunx/status.h"
#include "quincunx_gl/capabilities.h"

struct GLFWwindow;

namespace quincunx::scenes {

struct KeyPress {
  int key = 0;  // GLFW_KEY_...
  bool shift = false;
};

// The mouse since the last take_pointer(). Positions and ways are pixels of the framebuffer, +y down.
struct PointerUse {
  Vec2 position = {};
  Vec2 dragged = {};  // with the left button held
  int scrolled = 0;   // notches, up is positive
};

class Window {
 public:
  // Opens it with its context current. Without `vsync` pictures are shown as soon as they are there. Errors:
  // kUnsupported, saying why there is no display or no context.
  static Result<std::unique_ptr<Window>> create(Extent size, const std::string& title, bool vsync,
                                                gl::Api api);

  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  // Takes what has happened from the display. Waits up to `seconds` for something to happen.
  void poll(double seconds = 0);

  // Input since the last call, in order.
  std::vector<KeyPress> take_keys();
  PointerUse take_pointer();
  void press(const KeyPress& key) { keys_.push_back(key); }  // as if the keyboard had done it

  // As of the last poll().
  Extent framebuffer() const { return framebuffer_; }  // 0x0 while minimised, on some systems
  bool minimised() const { return minimised_; }
  bool closing() const;

  void resize(Extent size);
  void minimise();
  void restore();
  void swap();  // shows the back buffer

  GLFWwindow* handle() const { return window_; }

 private:
  explicit Window(GLFWwindow* window) : window_(window) {}
  void listen();
  void look();

  GLFWwindow* window_;
  Extent framebuffer_;
  bool minimised_ = false;
  std::vector<KeyPress> keys_;
  PointerUse pointer_;
  bool dragging_ = false;
};

// Makes the program end with exit status 1 and one sentence in the log when the window's X11 display goes away. In
// lost_display.cpp.
void end_when_display_is_lost();

}  // namespace quincunx::scenes
