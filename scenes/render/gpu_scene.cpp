// SPDX-License-Identifier: MIT
#include "render/gpu_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "quincunx_gl/gl_calls.h"
#include "render/frame_block.h"
#include "render/texture_upload.h"

namespace quincunx::scenes {
namespace {

std::size_t aligned(std::size_t bytes) {
  GLint alignment = 1;
  glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
  const auto step = static_cast<std::size_t>(alignment);
  return (bytes + step - 1) / step * step;
}

gl::Buffer buffer_of(const void* data, std::size_t bytes) {
  gl::Buffer buffer = gl::Buffer::create();
  constexpr std::size_t kSmallest = 16;  // GL has no empty buffers
  gl::buffer_storage(buffer.get(), static_cast<GLsizeiptr>(std::max(bytes, kSmallest)));
  if (bytes > 0) gl::buffer_write(buffer.get(), 0, static_cast<GLsizeiptr>(bytes), data);
  return buffer;
}

template <typename Block>
gl::Buffer block_buffer(const std::vector<Block>& blocks, std::size_t stride) {
  std::vector<std::byte> bytes(blocks.size() * stride);
  for (std::size_t i = 0; i < blocks.size(); ++i)
    std::memcpy(&bytes[i * stride], &blocks[i], sizeof(Block));
  return buffer_of(bytes.data(), bytes.size());
}

std::array<const TextureSlot*, 4> slots_of(const Material& material) {
  return {&material.base_colour_texture, &material.metallic_roughness_texture, &material.emissive_texture,
          &material.normal_texture};
}

MaterialBlock block_of(const Material& material) {
  MaterialBlock block;
  block.base_colour = material.base_colour;
  block.emissive = glm::vec4(material.emissive, material.alpha_cutoff);
  block.surface = {material.metallic, material.roughness, material.normal_scale, material.reactive};
  const auto slots = slots_of(material);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const glm::mat3 rows = glm::transpose(slots[i]->transform);
    block.uv[2 * i] = glm::vec4(rows[0], 0);
    block.uv[2 * i + 1] = glm::vec4(rows[1], 0);
  }
  return block;
}

// The cut-off with which a texture is alpha-tested, if it is.
std::optional<float> cutoff_of(const Scene& scene, int texture) {
  for (const Material& material : scene.materials) {
    if (material.alpha_mode == AlphaMode::kMask && material.base_colour_texture.texture == texture &&
        material.base_colour.a > 0) {
      return material.alpha_cutoff / material.base_colour.a;
    }
  }
  return std::nullopt;
}

}  // namespace

Result<GpuScene> GpuScene::upload(const Scene& scene, const SceneLayout& layout) {
  GpuScene gpu;
  if (Status status = gpu.upload_textures(scene); !status.ok()) return status;
  gpu.upload_meshes(scene, layout.indices);
  gpu.upload_materials(scene);
  gpu.upload_light_sets(layout.light_sets);
  return gpu;
}

void GpuScene::upload_meshes(const Scene& scene, const std::vector<std::uint32_t>& indices) {
  std::vector<Vertex> vertices;
  for (const Mesh& mesh : scene.meshes) {
    vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  }
  vertices_ = buffer_of(vertices.data(), vertices.size() * sizeof(Vertex));
  indices_ = buffer_of(indices.data(), indices.size() * sizeof(std::uint32_t));
}

Status GpuScene::upload_textures(const Scene& scene) {
  for (std::size_t t = 0; t < scene.textures.size(); ++t) {
    Result<gl::Texture> texture = upload_texture(scene.textures[t], cutoff_of(scene, static_cast<int>(t)));
    if (!texture.ok()) return texture.status();
    textures_.push_back(std::move(texture).value());
  }
  return {};
}

void GpuScene::upload_materials(const Scene& scene) {
  std::vector<MaterialBlock> blocks;
  for (const Material& material : scene.materials) {
    blocks.push_back(block_of(material));
    BoundMaterial bound{{}, material.double_sided};
    const auto slots = slots_of(material);
    for (std::size_t i = 0; i < slots.size(); ++i) {
      if (slots[i]->texture >= 0)
        bound.textures[i] = textures_[static_cast<std::size_t>(slots[i]->texture)].get();
    }
    materials_.push_back(bound);
  }
  material_stride_ = aligned(sizeof(MaterialBlock));
  material_blocks_ = block_buffer(blocks, material_stride_);
}

void GpuScene::upload_light_sets(const std::vector<LightsBlock>& sets) {
  light_stride_ = aligned(sizeof(LightsBlock));
  light_blocks_ = block_buffer(sets, light_stride_);
}

void GpuScene::bind_material(int material) const {
  const BoundMaterial& bound = materials_[static_cast<std::size_t>(material)];
  glBindBufferRange(GL_UNIFORM_BUFFER, kMaterialBinding, material_blocks_.get(),
                    static_cast<GLintptr>(static_cast<std::size_t>(material) * material_stride_),
                    sizeof(MaterialBlock));
  for (std::size_t unit = 0; unit < bound.textures.size(); ++unit)
    gl::bind_texture(static_cast<GLuint>(unit), bound.textures[unit]);
  bound.double_sided ? glDisable(GL_CULL_FACE) : glEnable(GL_CULL_FACE);
}

void GpuScene::bind_light_set(int set) const {
  if (set < 0) return;
  glBindBufferRange(GL_UNIFORM_BUFFER, kLightsBinding, light_blocks_.get(),
                    static_cast<GLintptr>(static_cast<std::size_t>(set) * light_stride_),
                    sizeof(LightsBlock));
}

}  // namespace quincunx::scenes
