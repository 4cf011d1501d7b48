// SPDX-License-Identifier: MIT
#include "covering_program.h"

#include <fmt/format.h>

#include <utility>

#include "cl_handle.h"

namespace quincunx::gl {
namespace {

constexpr const char* kVertexSource = R"(#version 310 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); })";

}  // namespace

Program covering_program(const char* fragment_source, const char* name) {
  Program program = Program::create();
  for (const auto& [stage, source] :
       {std::pair{GL_VERTEX_SHADER, kVertexSource}, {GL_FRAGMENT_SHADER, fragment_source}}) {
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

}  // namespace quincunx::gl
