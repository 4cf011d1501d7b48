// SPDX-License-Identifier: MIT
#include "bench/resize/respecified_targets.h"

#include <epoxy/gl.h>

#include <stdexcept>

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
    glTextureParameteri(texture.get(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(texture.get(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTextureParameteri(texture.get(), GL_TEXTURE_MAX_LEVEL, 0);
  }
  glNamedFramebufferDrawBuffers(framebuffer_.get(), static_cast<GLsizei>(kOutputs.size()), kOutputs.data());
}

void RespecifiedTargets::resize(Extent extent) {
  for (std::size_t i = 0; i < textures_.size(); ++i) {
    const auto& plane = kPlanes[i];
    glBindTexture(GL_TEXTURE_2D, textures_[i].get());
    glTexImage2D(GL_TEXTURE_2D, 0, plane.internal, extent.width, extent.height, 0, plane.format, plane.type,
                 nullptr);
    glNamedFramebufferTexture(framebuffer_.get(), plane.attachment, textures_[i].get(), 0);
  }
  glBindTexture(GL_TEXTURE_2D, 0);
  if (glCheckNamedFramebufferStatus(framebuffer_.get(), GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("a framebuffer of textures that were specified again is not complete");
}

void RespecifiedTargets::clear() const {
  constexpr std::array<GLfloat, 4> kZero = {0, 0, 0, 0};
  glClearNamedFramebufferfv(framebuffer_.get(), GL_DEPTH, 0, kZero.data());
  for (int output = 0; output < static_cast<int>(kOutputs.size()); ++output)
    glClearNamedFramebufferfv(framebuffer_.get(), GL_COLOR, output, kZero.data());
}

}  // namespace quincunx::bench
