// SPDX-License-Identifier: MIT
#include "bench/resize/respecified_targets.h"

#include <epoxy/gl.h>

#include <stdexcept>

#include "quincunx_gl/gl_calls.h"

namespace quincunx::bench {
namespace {

constexpr struct {
  GLint internal;
  GLenum format;
  GLenum type;
  GLenum attachment;
} kPlanes[] = {{GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, GL_COLOR_ATTACHMENT0},
               {GL_RG16F, GL_RG, GL_HALF_FLOAT, GL_COLOR_ATTACHMENT1},
               {GL_R8, GL_RED, GL_UNSIGNED_BYTE, GL_COLOR_ATTACHMENT2},
               {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, GL_DEPTH_ATTACHMENT}};
constexpr std::array<GLenum, 3> kOutputs = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};

}  // namespace

RespecifiedTargets::RespecifiedTargets() : framebuffer_(gl::Framebuffer::create()) {
  for (gl::Texture& texture : textures_) {
    texture = gl::Texture::create();
    gl::texture_parameter(texture.get(), GL_TEXTURE_MIN_FILTER, GLint{GL_NEAREST});
    gl::texture_parameter(texture.get(), GL_TEXTURE_MAG_FILTER, GLint{GL_NEAREST});
    gl::texture_parameter(texture.get(), GL_TEXTURE_MAX_LEVEL, GLint{0});
  }
  gl::draw_buffers(framebuffer_.get(), {kOutputs[0], kOutputs[1], kOutputs[2]});
}

void RespecifiedTargets::resize(Extent extent) {
  for (std::size_t i = 0; i < textures_.size(); ++i) {
    const auto& plane = kPlanes[i];
    glBindTexture(GL_TEXTURE_2D, textures_[i].get());
    glTexImage2D(GL_TEXTURE_2D, 0, plane.internal, extent.width, extent.height, 0, plane.format, plane.type,
                 nullptr);
    gl::attach(framebuffer_.get(), plane.attachment, textures_[i].get());
  }
  glBindTexture(GL_TEXTURE_2D, 0);
  if (gl::framebuffer_status(framebuffer_.get()) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("a framebuffer of textures that were specified again is not complete");
}

void RespecifiedTargets::clear() const {
  constexpr std::array<GLfloat, 4> kZero = {0, 0, 0, 0};
  gl::clear(framebuffer_.get(), GL_DEPTH, 0, kZero.data());
  for (int output = 0; output < static_cast<int>(kOutputs.size()); ++output)
    gl::clear(framebuffer_.get(), GL_COLOR, output, kZero.data());
}

}  // namespace quincunx::bench
