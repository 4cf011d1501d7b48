// SPDX-License-Identifier: MIT
// Ui: Dear ImGui in a window: fonts, looks, and when it is drawn. At the window's resolution, whatever the
// picture has.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "window/screen.h"
#include "window/window_settings.h"

struct GLFWwindow;

namespace quincunx::scenes {

// One at a time; on the window's thread, with its context current.
class Ui {
 public:
  explicit Ui(GLFWwindow* window);
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  // Calls `content`, which describes the interface by calls of Dear ImGui, and draws it; with kEverySecond
  // every other call shows the last layer again instead.
  void draw(const std::function<void()>& content, UiDrawing drawing, Screen& screen, Extent window);

  // Whether what is done with them is meant for the interface, not for what lies below it.
  bool wants_keys() const;
  bool wants_pointer() const;

  std::int64_t drawn() const { return drawn_; }  // times that `content` was called

 private:
  void draw_content(const std::function<void()>& content, GLuint framebuffer, Extent window);

  std::int64_t drawn_ = 0;
  bool layer_is_fresh_ = false;  // it was drawn in the last call
};

}  // namespace quincunx::scenes
