// SPDX-License-Identifier: MIT
#include "render/gl_state.h"

#include <epoxy/gl.h>

#include "quincunx_gl/capabilities.h"
#include "quincunx_gl/gl_calls.h"

namespace quincunx::scenes {
namespace {

constexpr GLuint kColour = 0;  // draw buffers of RenderTargets
constexpr GLuint kVelocity = 1;
constexpr GLuint kReactive = 2;

void write_to(bool velocity, bool reactive) {
  const auto mask = [](GLuint buffer, bool on) {
    const GLboolean value = on ? GL_TRUE : GL_FALSE;
    glColorMaski(buffer, value, value, value, value);
  };
  mask(kVelocity, velocity);
  mask(kReactive, reactive);
}

}  // namespace

DrawState::DrawState() {
  if (gl::capabilities().clip_control) glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  // Only for targets that hold encoded colour.
  if (gl::capabilities().encodes_on_demand) glEnable(GL_FRAMEBUFFER_SRGB);
  glDisable(GL_BLEND);
  set_winding(false);
  glCullFace(GL_BACK);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

DrawState::~DrawState() {
  if (gl::capabilities().clip_control) glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glDisable(GL_DEPTH_TEST);
  if (gl::capabilities().encodes_on_demand) glDisable(GL_FRAMEBUFFER_SRGB);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glFrontFace(GL_CCW);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glUseProgram(0);
  glBindVertexArray(0);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
}

// Where a shader turns y over, it turns the winding, too.
void set_winding(bool mirrored) {
  glFrontFace(mirrored == gl::capabilities().clip_control ? GL_CW : GL_CCW);
}

void clear_for_frame(const gl::RenderTargets& targets, Extent render) {
  const float zero[] = {0, 0, 0, 0};
  glDepthMask(GL_TRUE);
  glDisable(GL_SCISSOR_TEST);
  gl::clear(targets.framebuffer(), GL_DEPTH, 0, zero);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, render.width, render.height);
  if (targets.reactive() != 0) gl::clear(targets.framebuffer(), GL_COLOR, kReactive, zero);
}

void clear_particles(const gl::RenderTargets& targets, Extent viewport) {
  const float zero[] = {0, 0, 0, 0};
  glDisable(GL_STENCIL_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, viewport.width, viewport.height);
  gl::clear(targets.framebuffer(), GL_COLOR, kColour, zero);
  if (targets.reactive() != 0) gl::clear(targets.framebuffer(), GL_COLOR, kReactive, zero);
}

void fill_colour(const gl::RenderTargets& targets, glm::ivec2 corner, glm::ivec2 size, float value) {
  const float colour[] = {value, value, value, 1};
  glEnable(GL_SCISSOR_TEST);
  glScissor(corner.x, corner.y, size.x, size.y);
  gl::clear(targets.framebuffer(), GL_COLOR, kColour, colour);
}

void draw_checkerboard(int parity) {
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_EQUAL, parity, 1);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
}

void set_opaque_state() {
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_GREATER);
  write_to(true, false);
}

void set_sky_state() {
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_EQUAL);
  write_to(true, false);
}

void set_depth_only_state() {
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_ALWAYS);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
}

void set_blended_state() {
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);
  write_to(false, true);
  glEnablei(GL_BLEND, kColour);
  glEnablei(GL_BLEND, kReactive);
  glBlendFunci(kColour, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  // r + a (1 - r): marks add up and never exceed 1.
  glBlendFunci(kReactive, GL_ONE, GL_ONE_MINUS_SRC_COLOR);
}

}  // namespace quincunx::scenes
