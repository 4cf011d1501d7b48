// SPDX-License-Identifier: MIT
#include "render/shadow_map.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

#include "quincunx_gl/capabilities.h"
#include "quincunx_gl/gl_calls.h"
#include "render/gl_program.h"
#include "render/gpu_scene.h"

namespace quincunx::scenes {
namespace {

// Slope-scaled and constant depth bias, in units of the map; with the lift along the normal in surface.vert
// it keeps surfaces out of their own shadow.
constexpr float kSlopeBias = 1.5f;
constexpr float kConstantBias = 2.0f;

gl::Texture depth_texture() {
  gl::Texture texture = gl::Texture::create();
  const GLuint name = texture.get();
  gl::texture_storage(name, 1, GL_DEPTH_COMPONENT16, {kShadowTexels, kShadowTexels});
  gl::texture_parameter(name, GL_TEXTURE_COMPARE_MODE, static_cast<GLint>(GL_COMPARE_REF_TO_TEXTURE));
  gl::texture_parameter(name, GL_TEXTURE_COMPARE_FUNC, static_cast<GLint>(GL_LEQUAL));
  gl::texture_parameter(name, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(GL_LINEAR));
  gl::texture_parameter(name, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(GL_LINEAR));
  gl::texture_parameter(name, GL_TEXTURE_WRAP_S, static_cast<GLint>(GL_CLAMP_TO_BORDER));
  gl::texture_parameter(name, GL_TEXTURE_WRAP_T, static_cast<GLint>(GL_CLAMP_TO_BORDER));
  const float lit[] = {1, 1, 1, 1};
  gl::texture_border(name, lit);
  return texture;
}

Result<gl::Framebuffer> depth_framebuffer(GLuint texture) {
  gl::Framebuffer framebuffer = gl::Framebuffer::create();
  gl::attach(framebuffer.get(), GL_DEPTH_ATTACHMENT, texture);
  gl::draw_buffers(framebuffer.get(), {GL_NONE});
  if (gl::framebuffer_status(framebuffer.get()) != GL_FRAMEBUFFER_COMPLETE) {
    return Status::device(
        "the driver refuses a framebuffer with only a 16-bit depth texture, which shadows need");
  }
  return framebuffer;
}

// The part that is used and what is next to it.
int kept_side(int side) {
  return std::min(side + 1, kShadowTexels);
}

void clear_depth(GLuint framebuffer, int side) {
  const float infinity = 1;
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, side, side);
  gl::clear(framebuffer, GL_DEPTH, 0, &infinity);
  glDisable(GL_SCISSOR_TEST);
}

}  // namespace

Result<ShadowMap> ShadowMap::create(const Scene& scene, const SceneLayout& layout) {
  ShadowMap map;
  if (!layout.shadow.enabled) return map;
  for (const Mesh& mesh : scene.meshes) {
    const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    map.program_of_mesh_.push_back(material.alpha_mode != AlphaMode::kMask    ? kSolid
                                   : material.base_colour_texture.texture < 0 ? kCutOut
                                                                              : kCutOutByTexture);
  }
  const std::vector<std::string> defines[] = {{}, {"MASK"}, {"MASK", "TEXTURED"}};
  for (std::size_t p = 0; p < map.programs_.size(); ++p) {
    Result<gl::Program> program =
        link_program("shadow.vert.glsl", p == kSolid ? "nothing.frag.glsl" : "shadow.frag.glsl", defines[p]);
    if (!program.ok()) return program.status();
    map.programs_[p] = std::move(program).value();
  }
  map.texture_ = depth_texture();
  Result<gl::Framebuffer> framebuffer = depth_framebuffer(map.texture_.get());
  if (!framebuffer.ok()) return framebuffer.status();
  map.framebuffer_ = std::move(framebuffer).value();
  const std::size_t bytes = layout.instances.size() * sizeof(InstanceData);
  map.still_instances_ = StreamBuffer(bytes);
  if (!layout.shadow.moves) return map;
  map.still_texture_ = depth_texture();
  Result<gl::Framebuffer> still = depth_framebuffer(map.still_texture_.get());
  if (!still.ok()) return still.status();
  map.still_framebuffer_ = std::move(still).value();
  map.moving_instances_ = StreamBuffer(bytes);
  return map;
}

ShadowMap::Work ShadowMap::work_for(const SceneLayout& layout, double seconds, double most_age,
                                    int side) const {
  if (!texture_) return Work::kNothing;
  if (side != side_) return Work::kEverything;
  const bool stays = !layout.shadow.moves || std::abs(seconds - drawn_seconds_) <= most_age;
  return stays ? Work::kNothing : Work::kMoving;
}

void ShadowMap::update(Work work, const SceneLayout& layout, const GpuScene& gpu,
                       const std::vector<InstanceData>& placed, double seconds, int side) {
  if (work == Work::kNothing) return;
  side_ = side;
  drawn_seconds_ = seconds;
  const int kept = kept_side(side);
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  if (work == Work::kEverything) {
    const GLuint framebuffer = layout.shadow.moves ? still_framebuffer_.get() : framebuffer_.get();
    clear_depth(framebuffer, kept);
    list_.build_casters(layout, placed, false);
    draw(layout, gpu, framebuffer, still_instances_);
  }
  if (!layout.shadow.moves) return;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, still_framebuffer_.get());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.get());
  glBlitFramebuffer(0, 0, kept, kept, 0, 0, kept, kept, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  list_.build_casters(layout, placed, true);
  draw(layout, gpu, framebuffer_.get(), moving_instances_);
}

void ShadowMap::draw(const SceneLayout& layout, const GpuScene& gpu, GLuint framebuffer,
                     StreamBuffer& instances) {
  const std::vector<InstanceData>& data = list_.instances();
  const GLintptr offset = instances.write(data.data(), data.size() * sizeof(InstanceData));
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, side_, side_);
  const bool clamps = gl::capabilities().depth_clamp;
  if (clamps) glEnable(GL_DEPTH_CLAMP);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(kSlopeBias, kConstantBias);
  for (const Batch& batch : list_.opaque()) {
    const auto mesh = static_cast<std::size_t>(batch.range);
    glUseProgram(programs_[program_of_mesh_[mesh]].get());
    if (program_of_mesh_[mesh] != kSolid) gpu.bind_material(layout.meshes[mesh].material);
    glDisable(GL_CULL_FACE);  // open meshes cast shadows from both sides
    draw_mesh(layout.meshes[mesh], instances.get(), offset, batch.first, batch.count);
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  if (clamps) glDisable(GL_DEPTH_CLAMP);
}

}  // namespace quincunx::scenes
