// SPDX-License-Identifier: MIT
#include "window/screen.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

#include "quincunx_gl/gl_calls.h"
#include "render/gl_program.h"

namespace quincunx::scenes {
namespace {

constexpr const char* kWholeViewport = "sky.vert.glsl";

enum Uniform : GLint { kWindow = 0, kOrigin = 1, kZoom = 2, kSplit = 3 };  // of picture.frag

int corner(float centre, int factor, int extent) {
  const int shown = std::max(extent / factor, 1);
  const int middle = static_cast<int>(std::lround(centre * static_cast<float>(extent)));
  return std::clamp(middle - shown / 2, 0, extent - shown);
}

}  // namespace

ZoomOrigin zoom_origin(const ZoomSettings& zoom, Extent picture) {
  return {corner(zoom.centre.x, zoom.factor, picture.width),
          corner(zoom.centre.y, zoom.factor, picture.height)};
}

Result<Screen> Screen::create() {
  auto picture = link_program(kWholeViewport, "picture.frag.glsl", {});
  if (!picture.ok()) return picture.status();
  auto layer = link_program(kWholeViewport, "layer.frag.glsl", {});
  if (!layer.ok()) return layer.status();
  return Screen(std::move(picture).value(), std::move(layer).value());
}

void Screen::show(const ScreenPicture& picture, const ZoomSettings& zoom, float split, Extent window) {
  const ZoomOrigin origin = zoom_origin(zoom, picture.extent);
  const bool splits = picture.compared != 0;
  const auto side = static_cast<int>(std::lround(split * static_cast<float>(window.width)));
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glViewport(0, 0, window.width, window.height);
  glBindVertexArray(nothing_.get());
  glUseProgram(picture_program_.get());
  glUniform2i(kWindow, window.width, window.height);
  glUniform2i(kOrigin, origin.x, origin.y);
  glUniform1i(kZoom, zoom.factor);
  glUniform1i(kSplit, splits ? side : window.width);
  gl::bind_texture(0, picture.picture);
  gl::bind_texture(1, splits ? picture.compared : picture.picture);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  gl::bind_texture(0, 0);
  gl::bind_texture(1, 0);
  glUseProgram(0);
  glBindVertexArray(0);
}

Screen::Layer Screen::layer(Extent window) {
  const bool renewed = layer_extent_ != window;
  if (renewed) {
    layer_texture_ = gl::Texture::create();
    gl::texture_storage(layer_texture_.get(), 1, GL_RGBA8, window);
    layer_framebuffer_ = gl::Framebuffer::create();
    gl::attach(layer_framebuffer_.get(), GL_COLOR_ATTACHMENT0, layer_texture_.get());
    layer_extent_ = window;
    clear_layer();
  }
  return {layer_framebuffer_.get(), renewed};
}

void Screen::clear_layer() {
  const float zero[] = {0, 0, 0, 0};
  gl::clear(layer_framebuffer_.get(), GL_COLOR, 0, zero);
}

void Screen::lay_over(Extent window) {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glViewport(0, 0, window.width, window.height);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glBindVertexArray(nothing_.get());
  glUseProgram(layer_program_.get());
  gl::bind_texture(0, layer_texture_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  gl::bind_texture(0, 0);
  glUseProgram(0);
  glBindVertexArray(0);
  glDisable(GL_BLEND);
}

std::vector<std::uint8_t> Screen::read(Extent window) {
  const std::size_t row = static_cast<std::size_t>(window.width) * 4;
  std::vector<std::uint8_t> pixels(row * static_cast<std::size_t>(window.height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glReadBuffer(GL_BACK);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
  glReadPixels(0, 0, window.width, window.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  for (int y = 0; y < window.height / 2; ++y) {
    const auto top = pixels.begin() + static_cast<std::ptrdiff_t>(row) * y;
    const auto bottom = pixels.begin() + static_cast<std::ptrdiff_t>(row) * (window.height - 1 - y);
    std::swap_ranges(top, top + static_cast<std::ptrdiff_t>(row), bottom);
  }
  return pixels;
}

}  // namespace quincunx::scenes
