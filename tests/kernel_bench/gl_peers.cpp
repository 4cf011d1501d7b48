// SPDX-License-Identifier: MIT
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <memory>
#include <random>
#include <stdexcept>

#include "gl_peer_shaders.h"
#include "peers.h"
#include "quincunx_gl/handle.h"
#include "stage.h"

namespace quincunx::bench {
namespace {

GLuint compiled(GLenum stage, std::initializer_list<const char*> sources) {
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, static_cast<GLsizei>(sources.size()), sources.begin(), nullptr);
  glCompileShader(shader);
  return shader;
}

gl::Program linked(const char* fragment) {
  gl::Program program = gl::Program::create();
  const GLuint shaders[] = {compiled(GL_VERTEX_SHADER, {kVersion, kFullScreenTriangle}),
                            compiled(GL_FRAGMENT_SHADER, {kVersion, kInputs, fragment})};
  for (const GLuint shader : shaders) {
    glAttachShader(program.get(), shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program.get());
  GLint done = GL_FALSE;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &done);
  if (done == GL_TRUE) return program;
  char log[2048] = {};
  glGetProgramInfoLog(program.get(), sizeof(log), nullptr, log);
  throw std::runtime_error(fmt::format("a GLSL peer does not link: {}", log));
}

gl::Texture texture(Extent extent, GLenum format, GLenum filter) {
  gl::Texture made = gl::Texture::create();
  glTextureStorage2D(made.get(), 1, format, extent.width, extent.height);
  for (const GLenum name : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTextureParameteri(made.get(), name, static_cast<GLint>(filter));
  for (const GLenum name : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTextureParameteri(made.get(), name, GL_CLAMP_TO_EDGE);
  return made;
}

void fill(const gl::Texture& target, Extent extent, float low, float high) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(low, high);
  std::vector<float> values(static_cast<std::size_t>(extent.area()) * 4);
  for (float& value : values)
    value = uniform(random);
  glTextureSubImage2D(target.get(), 0, 0, 0, extent.width, extent.height, GL_RGBA, GL_FLOAT, values.data());
}

// Two frames at the render extent and the picture that the passes write.
struct Surface {
  Surface(Extent picture, Extent frame) : output(picture), render(frame) {
    for (gl::Texture& colour : colours) {
      colour = texture(render, GL_RGBA16F, GL_LINEAR);
      fill(colour, render, 0.1f, 1);
    }
    for (gl::Texture& velocity : velocities) {
      velocity = texture(render, GL_RG16F, GL_NEAREST);
      fill(velocity, render, -0.01f, 0.01f);
    }
    glNamedFramebufferTexture(framebuffer.get(), GL_COLOR_ATTACHMENT0, result.get(), 0);
    if (glCheckNamedFramebufferStatus(framebuffer.get(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw std::runtime_error("the GLSL peers need a renderable RGBA32F texture");
  }

  void draw(GLuint program) const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
    glViewport(0, 0, output.width, output.height);
    glBindVertexArray(vertices.get());
    const GLuint inputs[] = {colours[0].get(), colours[1].get(), velocities[0].get(), velocities[1].get()};
    glBindTextures(0, 4, inputs);
    glUseProgram(program);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, ~GLuint64{0});
    glDeleteSync(fence);
  }

  Extent output, render;
  gl::Texture colours[2], velocities[2];
  gl::Texture result = texture(output, GL_RGBA32F, GL_NEAREST);
  gl::Framebuffer framebuffer = gl::Framebuffer::create();
  gl::VertexArray vertices = gl::VertexArray::create();
};

}  // namespace

void add_gl_peers(std::vector<Case>& cases, Extent output, double scale) {
  const Extent render = scaled(output, scale);
  const auto surface = std::make_shared<Surface>(output, render);
  const std::uint64_t colour = bytes_of(render, PixelFormat::kRGBA16F);
  const std::uint64_t velocity = bytes_of(render, PixelFormat::kRG16F);
  const auto add = [&](const char* name, const char* fragment, std::uint64_t read) {
    const auto program = std::make_shared<gl::Program>(linked(fragment));
    cases.push_back({.name = fmt::format("GLSL {} {:.2f}", name, scale),
                     .scale = scale,
                     .bytes = read + bytes_of(output, PixelFormat::kRGBA32F),
                     .run = [=] { return wall_ms([&] { surface->draw(program->get()); }); }});
  };
  add("bilinear", kBilinear, colour);
  add("b-spline", kBSpline, colour);
  add("catmull-rom", kCatmullRom, colour);
  add("seed resolve", kSeedResolve, 2 * (colour + velocity));
  add("8-tap blur", kBlur, colour + velocity);
}

}  // namespace quincunx::bench
