// SPDX-License-Identifier: MIT
#include "quincunx_gl/target_readback.h"

namespace quincunx::gl {
namespace {

template <typename T>
std::vector<T> read_texture(GLuint texture, Extent render, GLenum format, GLenum type, int channels) {
  if (texture == 0) return {};
  std::vector<T> pixels(static_cast<std::size_t>(render.area()) * channels);
  glGetTextureSubImage(texture, 0, 0, 0, 0, render.width, render.height, 1, format, type,
                       static_cast<GLsizei>(pixels.size() * sizeof(T)), pixels.data());
  return pixels;
}

}  // namespace

TargetPixels read_targets(const RenderTargets& targets, Extent render) {
  GLint alignment = 4;
  glGetIntegerv(GL_PACK_ALIGNMENT, &alignment);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  TargetPixels pixels;
  pixels.render = render;
  if (targets.colour_format() == PixelFormat::kRGBA8) {
    pixels.codes = read_texture<std::uint8_t>(targets.colour(), render, GL_RGBA, GL_UNSIGNED_BYTE, 4);
  } else {
    pixels.colour = read_texture<std::uint16_t>(targets.colour(), render, GL_RGBA, GL_HALF_FLOAT, 4);
  }
  pixels.depth = read_texture<float>(targets.depth(), render, GL_DEPTH_COMPONENT, GL_FLOAT, 1);
  pixels.velocity = read_texture<std::uint16_t>(targets.velocity(), render, GL_RG, GL_HALF_FLOAT, 2);
  pixels.reactive = read_texture<std::uint8_t>(targets.reactive(), render, GL_RED, GL_UNSIGNED_BYTE, 1);
  glPixelStorei(GL_PACK_ALIGNMENT, alignment);
  return pixels;
}

}  // namespace quincunx::gl
