// SPDX-License-Identifier: MIT
#include "render/particle_layer.h"

#include "quincunx_gl/gl_calls.h"
#include "render/gl_program.h"
#include "render/gl_state.h"

namespace quincunx::scenes {
namespace {

constexpr GLint kFrameExtent = 0;  // uniforms of particle_depth.frag
constexpr GLint kExtent = 1;
constexpr GLint kParity = 2;
constexpr GLint kEveryPixel = -1;

}  // namespace

Result<ParticleLayer> ParticleLayer::create() {
  Result<gl::Program> program = link_program("sky.vert.glsl", "particle_depth.frag.glsl", {});
  if (!program.ok()) return program.status();
  ParticleLayer layer;
  layer.program_ = std::move(program).value();
  layer.nothing_ = gl::VertexArray::create();
  return layer;
}

void ParticleLayer::begin(const gl::RenderTargets& frame, const FrameView& view,
                          const gl::RenderTargets& particles) const {
  const Extent extent = view.particles;
  clear_particles(particles, extent);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, particles.framebuffer());
  glViewport(0, 0, extent.width, extent.height);
  set_depth_only_state();
  glBindVertexArray(nothing_.get());
  const GLuint program = program_.get();
  glUseProgram(program);
  glProgramUniform2i(program, kFrameExtent, view.render.width, view.render.height);
  glProgramUniform2i(program, kExtent, extent.width, extent.height);
  glProgramUniform1i(program, kParity, view.parity.value_or(kEveryPixel));
  gl::bind_texture(0, frame.depth());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  gl::bind_texture(0, 0);
}

}  // namespace quincunx::scenes
