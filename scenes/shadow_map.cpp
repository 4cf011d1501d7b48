// SPDX-License-Identifier: MIT
#include "shadow_map.h"

#include <epoxy/gl.h>

#include "gl_program.h"
#include "vertex_input.h"

namespace quincunx::scenes {
namespace {

// Slope-scaled and constant depth bias, in units of the map; with the lift along the normal in surface.vert
// it keeps surfaces out of their own shadow.
constexpr float kSlopeBias = 1.5f;
constexpr float kConstantBias = 2.0f;

gl::Texture depth_texture() {
  gl::Texture texture = gl::Texture::create();
  const GLuint name = texture.get();
  glTextureStorage2D(name, 1, GL_DEPTH_COMPONENT16, kShadowTexels, kShadowTexels);
  glTextureParameteri(name, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTextureParameteri(name, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  const float lit[] = {1, 1, 1, 1};
  glTextureParameterfv(name, GL_TEXTURE_BORDER_COLOR, lit);
  return texture;
}

}  // namespace

Result<ShadowMap> ShadowMap::create(const Scene& scene, const SceneLayout& layout) {
  ShadowMap map;
  if (!layout.shadow.enabled) return map;
  for (const Mesh& mesh : scene.meshes) {
    const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    map.mask_of_mesh_.push_back(material.alpha_mode == AlphaMode::kMask &&
                                material.base_colour_texture.texture >= 0);
  }
  Result<gl::Program> solid = link_program("shadow.vert.glsl", "", {});
  if (!solid.ok()) return solid.status();
  map.solid_ = std::move(solid).value();
  Result<gl::Program> cut_out = link_program("shadow.vert.glsl", "shadow.frag.glsl", {"MASK"});
  if (!cut_out.ok()) return cut_out.status();
  map.cut_out_ = std::move(cut_out).value();
  map.texture_ = depth_texture();
  map.framebuffer_ = gl::Framebuffer::create();
  glNamedFramebufferTexture(map.framebuffer_.get(), GL_DEPTH_ATTACHMENT, map.texture_.get(), 0);
  glNamedFramebufferDrawBuffer(map.framebuffer_.get(), GL_NONE);
  if (glCheckNamedFramebufferStatus(map.framebuffer_.get(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    return Status::device(
        "the driver refuses a framebuffer with only a 16-bit depth texture, which shadows need");
  }
  map.instances_ = StreamBuffer(layout.instances.size() * sizeof(InstanceData));
  return map;
}

void ShadowMap::update(const SceneLayout& layout, const GpuScene& gpu,
                       const std::vector<InstanceData>& placed, double seconds) {
  if (!texture_) return;
  const bool drawn = drawn_seconds_ == drawn_seconds_;
  if (drawn && (!layout.shadow.moves || drawn_seconds_ == seconds)) return;
  drawn_seconds_ = seconds;
  list_.build_casters(layout, placed);
  draw(layout, gpu);
}

void ShadowMap::draw(const SceneLayout& layout, const GpuScene& gpu) {
  const std::vector<InstanceData>& data = list_.instances();
  const GLintptr offset = instances_.write(data.data(), data.size() * sizeof(InstanceData));
  glBindVertexBuffer(kInstanceSlot, instances_.get(), offset, sizeof(InstanceData));

  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.get());
  glViewport(0, 0, kShadowTexels, kShadowTexels);
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glEnable(GL_DEPTH_CLAMP);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(kSlopeBias, kConstantBias);
  const float infinity = 1;
  glClearNamedFramebufferfv(framebuffer_.get(), GL_DEPTH, 0, &infinity);
  for (const Batch& batch : list_.opaque()) {
    const auto mesh = static_cast<std::size_t>(batch.mesh);
    glUseProgram(mask_of_mesh_[mesh] ? cut_out_.get() : solid_.get());
    if (mask_of_mesh_[mesh]) gpu.bind_material(layout.meshes[mesh].material);
    glDisable(GL_CULL_FACE);  // open meshes cast shadows from both sides
    draw_mesh(layout.meshes[mesh], batch.first, batch.count);
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_DEPTH_CLAMP);
}

}  // namespace quincunx::scenes
