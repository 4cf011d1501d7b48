// SPDX-License-Identifier: MIT
#include "depth_copy.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "cl_handle.h"
#include "quincunx_gl/gl_calls.h"

namespace quincunx::gl {
namespace {

constexpr int kGroupSide = 8;

constexpr const char* kSource = R"(#version 310 es
precision highp float;
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform highp sampler2D depth;
layout(binding = 0, r32f) writeonly uniform highp image2D copy;
layout(location = 0) uniform ivec2 render;
void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, render))) return;
  imageStore(copy, texel, vec4(texelFetch(depth, texel, 0).r));
})";

GLuint groups(int texels) {
  return static_cast<GLuint>((texels + kGroupSide - 1) / kGroupSide);
}

}  // namespace

GLuint SamplerTraits::create() {
  GLuint name = 0;
  glGenSamplers(1, &name);
  glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return name;
}

Program compute_program(const std::string& text) {
  const char* const source = text.c_str();
  Program program = Program::adopt(glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &source));
  GLint linked = GL_FALSE;
  if (program) glGetProgramiv(program.get(), GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return program;
  std::string log(1024, '\0');
  GLsizei length = 0;
  if (program) glGetProgramInfoLog(program.get(), static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  throw InteropError(fmt::format("the compute shader that copies texels was refused: {}", log));
}

DepthCopy DepthCopy::create() {
  DepthCopy made;
  made.program_ = compute_program(kSource);
  made.sampler_ = Handle<SamplerTraits>::create();
  return made;
}

void DepthCopy::copy(GLuint depth, GLuint to, Extent render, Before before) const {
  const ComputeScope restore(before);
  glUseProgram(program_.get());
  glUniform2i(0, render.width, render.height);
  glBindTexture(GL_TEXTURE_2D, depth);
  glBindSampler(0, sampler_.get());
  glBindImageTexture(0, to, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32F);
  glDispatchCompute(groups(render.width), groups(render.height), 1);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

DepthReader::DepthReader(Extent target)
    : copy_(Texture::create()), framebuffer_(Framebuffer::create()), to_copy_(DepthCopy::create()) {
  texture_storage(copy_.get(), 1, GL_R32F, target);
  attach(framebuffer_.get(), GL_COLOR_ATTACHMENT0, copy_.get());
  if (framebuffer_status(framebuffer_.get()) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("the driver draws into no R32F texture, through which depth is read");
}

void DepthReader::read(GLuint depth, Extent render, void* pixels, Before before) const {
  to_copy_.copy(depth, copy_.get(), render, before);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.get());
  glReadPixels(0, 0, render.width, render.height, GL_RED, GL_FLOAT, pixels);
}

}  // namespace quincunx::gl
