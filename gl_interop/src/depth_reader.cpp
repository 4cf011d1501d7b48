// SPDX-License-Identifier: MIT
#include "depth_reader.h"

#include <stdexcept>

#include "covering_program.h"
#include "quincunx_gl/gl_calls.h"

namespace quincunx::gl {
namespace {

constexpr const char* kFragmentSource = R"(#version 310 es
precision highp float;
layout(binding = 0) uniform highp sampler2D depth;
layout(location = 0) out float copy;
void main() { copy = texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r; })";

}  // namespace

DepthReader::DepthReader(Extent target)
    : copy_(Texture::create()),
      framebuffer_(Framebuffer::create()),
      program_(covering_program(kFragmentSource, "the program that reads depth")),
      nothing_(VertexArray::create()) {
  texture_storage(copy_.get(), 1, GL_R32F, target);
  attach(framebuffer_.get(), GL_COLOR_ATTACHMENT0, copy_.get());
  if (framebuffer_status(framebuffer_.get()) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("the driver draws into no R32F texture, through which depth is read");
}

void DepthReader::read(GLuint depth, Extent render, void* pixels) const {
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.get());
  glViewport(0, 0, render.width, render.height);
  glBindVertexArray(nothing_.get());
  glUseProgram(program_.get());
  bind_texture(0, depth);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  bind_texture(0, 0);
  glUseProgram(0);
  glBindVertexArray(0);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  read_attachment(framebuffer_.get(), GL_COLOR_ATTACHMENT0, render, GL_RED, GL_FLOAT, pixels);
}

}  // namespace quincunx::gl
