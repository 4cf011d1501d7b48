// SPDX-License-Identifier: MIT
#include "viewport_pass.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "cl_handle.h"
#include "quincunx_gl/gl_calls.h"

namespace quincunx::gl {
namespace {

constexpr const char* kCoveringSource = R"(#version 310 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); })";

constexpr const char* kDepthSource = R"(#version 310 es
precision highp float;
layout(binding = 0) uniform highp sampler2D depth;
layout(location = 0) out float copy;
void main() { copy = texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r; })";

}  // namespace

Program covering_program(const char* fragment_source, const char* name) {
  Program program = Program::create();
  for (const auto& [stage, source] :
       {std::pair{GL_VERTEX_SHADER, kCoveringSource}, {GL_FRAGMENT_SHADER, fragment_source}}) {
    const GLuint shader = glCreateShader(static_cast<GLenum>(stage));
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    glAttachShader(program.get(), shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program.get());
  GLint linked = GL_FALSE;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &linked);
  if (linked == GL_FALSE) throw InteropError(fmt::format("{} does not link", name));
  return program;
}

DepthReader::DepthReader(Extent target)
    : copy_(Texture::create()),
      framebuffer_(Framebuffer::create()),
      program_(covering_program(kDepthSource, "the program that reads depth")),
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
