// SPDX-License-Identifier: MIT
#include "quincunx_gl/target_readback.h"

#include "depth_reader.h"
#include "quincunx_gl/capabilities.h"
#include "quincunx_gl/gl_calls.h"

namespace quincunx::gl {
namespace {

template <typename T>
std::vector<T> read_plane(const RenderTargets& targets, GLenum attachment, Extent render, GLenum format,
                          GLenum type, int channels) {
  std::vector<T> pixels(static_cast<std::size_t>(render.area()) * channels);
  read_attachment(targets.framebuffer(), attachment, render, format, type, pixels.data());
  return pixels;
}

std::vector<float> read_depth(const RenderTargets& targets, Extent render) {
  std::vector<float> pixels(static_cast<std::size_t>(render.area()));
  if (capabilities().reads_depth) {
    read_attachment(targets.framebuffer(), GL_COLOR_ATTACHMENT0, render, GL_DEPTH_COMPONENT, GL_FLOAT,
                    pixels.data());
  } else {
    DepthReader(targets.extent()).read(targets.depth(), render, pixels.data());
  }
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
    pixels.codes =
        read_plane<std::uint8_t>(targets, GL_COLOR_ATTACHMENT0, render, GL_RGBA, GL_UNSIGNED_BYTE, 4);
  } else {
    pixels.colour =
        read_plane<std::uint16_t>(targets, GL_COLOR_ATTACHMENT0, render, GL_RGBA, GL_HALF_FLOAT, 4);
  }
  pixels.depth = read_depth(targets, render);
  if (targets.velocity() != 0) {
    pixels.velocity =
        read_plane<std::uint16_t>(targets, GL_COLOR_ATTACHMENT1, render, GL_RG, GL_HALF_FLOAT, 2);
  }
  if (targets.reactive() != 0) {
    pixels.reactive =
        read_plane<std::uint8_t>(targets, GL_COLOR_ATTACHMENT2, render, GL_RED, GL_UNSIGNED_BYTE, 1);
  }
  glPixelStorei(GL_PACK_ALIGNMENT, alignment);
  return pixels;
}

}  // namespace quincunx::gl
