// SPDX-License-Identifier: MIT
#include "render/truth_targets.h"

#include <epoxy/gl.h>

#include <stdexcept>

#include "quincunx_gl/gl_calls.h"
#include "render/gl_program.h"
#include "render/gl_state.h"

namespace quincunx::scenes {

TruthTargets::TruthTargets(Extent output)
    : frame_({output, false, false}),
      sum_(gl::Texture::create()),
      sum_framebuffer_(gl::Framebuffer::create()),
      nothing_(gl::VertexArray::create()) {
  gl::texture_storage(sum_.get(), 1, GL_RGBA32F, output);
  gl::attach(sum_framebuffer_.get(), GL_COLOR_ATTACHMENT0, sum_.get());
}

Result<TruthTargets> TruthTargets::create(Extent output) {
  try {
    TruthTargets targets(output);
    if (gl::framebuffer_status(targets.sum_framebuffer_.get()) != GL_FRAMEBUFFER_COMPLETE) {
      return Status::device(
          "the driver refuses a framebuffer with an RGBA32F texture, which truth is summed up in");
    }
    Result<gl::Program> program = link_program("sky.vert.glsl", "accumulate.frag.glsl", {});
    if (!program.ok()) return program.status();
    targets.program_ = std::move(program).value();
    return targets;
  } catch (const std::runtime_error& error) {
    return Status::device(error.what());
  }
}

void TruthTargets::clear() {
  const float zero[] = {0, 0, 0, 0};
  gl::clear(sum_framebuffer_.get(), GL_COLOR, 0, zero);
}

void TruthTargets::add(float weight) {
  const DrawState state;
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, sum_framebuffer_.get());
  glViewport(0, 0, extent().width, extent().height);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glBindVertexArray(nothing_.get());
  glUseProgram(program_.get());
  glProgramUniform1f(program_.get(), 0, weight);
  gl::bind_texture(0, frame_.colour());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

std::vector<float> TruthTargets::read() const {
  std::vector<float> pixels(static_cast<std::size_t>(frame_.extent().area()) * 4);
  gl::read_attachment(sum_framebuffer_.get(), GL_COLOR_ATTACHMENT0, frame_.extent(), GL_RGBA, GL_FLOAT,
                      pixels.data());
  return pixels;
}

}  // namespace quincunx::scenes
