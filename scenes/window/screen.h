// SPDX-License-Identifier: MIT
// The contents of the window: Screen brings the picture, and a layer over it, to the back buffer; Ui draws the
// interface into that layer.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "quincunx/advanced/extent.h"
#include "quincunx/status.h"
#include "quincunx_gl/handle.h"
#include "window/window_settings.h"

struct GLFWwindow;

namespace quincunx::scenes {

// The pixel of the picture that the window's top left corner shows, at this zoom.
struct ZoomOrigin {
  int x = 0;
  int y = 0;
};
ZoomOrigin zoom_origin(const ZoomSettings& zoom, Extent picture);

struct ScreenPicture {
  GLuint picture = 0;   // RGBA8, row 0 on top
  GLuint compared = 0;  // the same extent; 0: no split
  Extent extent = {};
};

class Screen {
 public:
  // Errors: kDeviceFailure with the driver's log.
  static Result<Screen> create();

  // The picture over the whole window.
  void show(const ScreenPicture& picture, const ZoomSettings& zoom, float split, Extent window);

  // A layer with a framebuffer of its own, of the window's extent: made anew when that changes, which
  // `renewed` tells. It is empty then.
  struct Layer {
    GLuint framebuffer = 0;
    bool renewed = false;
  };
  Layer layer(Extent window);
  void clear_layer();
  void lay_over(Extent window);

  // The back buffer, RGBA8, tightly packed, top row first; waits.
  static std::vector<std::uint8_t> read(Extent window);

 private:
  Screen(gl::Program picture, gl::Program layer)
      : picture_program_(std::move(picture)),
        layer_program_(std::move(layer)),
        nothing_(gl::VertexArray::create()) {}

  gl::Program picture_program_;
  gl::Program layer_program_;
  gl::VertexArray nothing_;
  gl::Texture layer_texture_;
  gl::Framebuffer layer_framebuffer_;
  Extent layer_extent_;
};

// Dear ImGui in a window: fonts, looks, and when it is drawn. At the window's resolution, whatever the picture has.
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
