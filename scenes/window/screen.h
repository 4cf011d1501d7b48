// SPDX-License-Identifier: MIT
// Screen: brings the picture, and a layer over it, to the window's back buffer.
#pragma once

#include <cstdint>
#include <vector>

#include "quincunx/extent.h"
#include "quincunx/status.h"
#include "quincunx_gl/handle.h"
#include "window/window_settings.h"

namespace quincunx::scenes {

// Which pixel of the picture the window's top left corner shows, at this zoom.
struct ZoomOrigin {
  int x = 0;
  int y = 0;
};
ZoomOrigin zoom_origin(const ZoomSettings& zoom, Extent picture);

struct ScreenPicture {
  GLuint picture = 0;   // RGBA8, row 0 on top
  GLuint compared = 0;  // of the same extent; 0: no split
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

}  // namespace quincunx::scenes
