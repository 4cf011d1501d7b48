// SPDX-License-Identifier: MIT
// GpuScene: what never changes of a scene, on the GPU: meshes, textures, materials, light sets; and how meshes are
// drawn.
#pragma once

#include <array>
#include <vector>

#include "quincunx/status.h"
#include "quincunx_gl/handle.h"
#include "render/scene_layout.h"

namespace quincunx::scenes {

class GpuScene {
 public:
  static Result<GpuScene> upload(const Scene& scene, const SceneLayout& layout);

  // Binds uniform block, textures and face culling of a material.
  void bind_material(int material) const;
  void bind_light_set(int set) const;  // -1: nothing to bind

  GLuint vertices() const { return vertices_.get(); }
  GLuint indices() const { return indices_.get(); }

 private:
  struct BoundMaterial {
    std::array<GLuint, 4> textures{};
    bool double_sided = false;
  };

  void upload_meshes(const Scene& scene, const std::vector<std::uint32_t>& indices);
  Status upload_textures(const Scene& scene);
  void upload_materials(const Scene& scene);
  void upload_light_sets(const std::vector<LightsBlock>& sets);

  gl::Buffer vertices_;
  gl::Buffer indices_;
  gl::Buffer material_blocks_;
  gl::Buffer light_blocks_;
  std::size_t material_stride_ = 0;
  std::size_t light_stride_ = 0;
  std::vector<gl::Texture> textures_;
  std::vector<BoundMaterial> materials_;
};

// Vertex layouts. Buffer bindings: 0 per vertex, 1 per instance.
inline constexpr GLuint kVertexSlot = 0;
inline constexpr GLuint kInstanceSlot = 1;

gl::VertexArray surface_vertex_array(const GpuScene& gpu);  // the instance buffer is bound per frame
gl::VertexArray particle_vertex_array();                    // the same

// Draws instances of a mesh; the vertex array, program and material are bound. `instances`: a buffer of InstanceData
// from `offset` on, of which `count` from `first` on are drawn.
void draw_mesh(const MeshRange& mesh, GLuint instances, GLintptr offset, std::uint32_t first,
               std::uint32_t count);

}  // namespace quincunx::scenes
