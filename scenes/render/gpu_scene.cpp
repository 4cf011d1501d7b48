// SPDX-License-Identifier: MIT
#include "render/gpu_scene.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

#include "quincunx/status.h"
#include "quincunx_gl/gl_calls.h"
#include "quincunx_gl/handle.h"
#include "render/frame_block.h"
#include "scene.h"

namespace quincunx::scenes {
namespace {

constexpr float kAnisotropy = 8;
constexpr int kBisections = 12;  // halvings of the alpha scale's range: 1 / 4096 of it

struct Level {
  int width = 0;
  int height = 0;
  std::vector<glm::vec4> texels;  // linear
};

float linear_of(std::uint8_t code, bool srgb) {
  const float c = static_cast<float>(code) / 255;
  if (!srgb) return c;
  return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

std::uint8_t code_of(float value, bool srgb) {
  const float c = std::clamp(value, 0.0f, 1.0f);
  const float coded = !srgb ? c : c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(coded * 255));
}

Level first_level(const Texture& texture) {
  Level level{texture.width, texture.height, {}};
  level.texels.reserve(texture.rgba.size() / 4);
  for (std::size_t i = 0; i < texture.rgba.size(); i += 4) {
    const std::uint8_t* t = &texture.rgba[i];
    level.texels.emplace_back(linear_of(t[0], texture.srgb), linear_of(t[1], texture.srgb),
                              linear_of(t[2], texture.srgb), static_cast<float>(t[3]) / 255);
  }
  return level;
}

// 2x2 box (clamped at odd edges), colours weighted by alpha.
Level half_of(const Level& from) {
  Level to{std::max(from.width / 2, 1), std::max(from.height / 2, 1), {}};
  to.texels.reserve(static_cast<std::size_t>(to.width) * to.height);
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      glm::vec3 colour(0), plain(0);
      float alpha = 0;
      for (int k = 0; k < 4; ++k) {
        const int sx = std::min(2 * x + (k & 1), from.width - 1);
        const int sy = std::min(2 * y + (k >> 1), from.height - 1);
        const glm::vec4& t = from.texels[static_cast<std::size_t>(sy) * from.width + sx];
        colour += glm::vec3(t) * t.a;
        plain += glm::vec3(t);
        alpha += t.a;
      }
      to.texels.emplace_back(alpha > 0 ? colour / alpha : plain * 0.25f, alpha * 0.25f);
    }
  }
  return to;
}

float coverage(const Level& level, float cutoff, float scale) {
  const auto passing = std::count_if(level.texels.begin(), level.texels.end(),
                                     [&](const glm::vec4& t) { return t.a * scale >= cutoff; });
  return static_cast<float>(passing) / static_cast<float>(level.texels.size());
}

// The scale of alpha with which a level covers as much as level 0 does, as nearly as its texels allow.
float alpha_scale(const Level& level, float cutoff, float wanted) {
  float low = 0, high = 8;
  for (int i = 0; i < kBisections; ++i) {
    const float middle = 0.5f * (low + high);
    (coverage(level, cutoff, middle) < wanted ? low : high) = middle;
  }
  const float above = coverage(level, cutoff, high) - wanted;
  return above <= wanted - coverage(level, cutoff, low) ? high : low;
}

void upload_level(GLuint name, int index, const Level& level, float scale, bool srgb) {
  std::vector<std::uint8_t> codes;
  codes.reserve(level.texels.size() * 4);
  for (const glm::vec4& t : level.texels) {
    for (int c = 0; c < 3; ++c)
      codes.push_back(code_of(t[c], srgb));
    codes.push_back(code_of(t.a * scale, false));
  }
  gl::texture_write(name, index, {level.width, level.height}, GL_RGBA, GL_UNSIGNED_BYTE, codes.data());
}

void upload_tested_levels(GLuint name, int levels, const Texture& texture, float cutoff) {
  Level level = first_level(texture);
  const float wanted = coverage(level, cutoff, 1);
  for (int i = 1; i < levels; ++i) {
    level = half_of(level);
    // Nothing or everything passes: no scale is needed, and none would be found.
    const float scale = wanted > 0 && wanted < 1 ? alpha_scale(level, cutoff, wanted) : 1;
    upload_level(name, i, level, scale, texture.srgb);
  }
}

GLint wrap_mode(Wrap wrap) {
  switch (wrap) {
    case Wrap::kClamp:
      return GL_CLAMP_TO_EDGE;
    case Wrap::kMirror:
      return GL_MIRRORED_REPEAT;
    case Wrap::kRepeat:
      break;
  }
  return GL_REPEAT;
}

// Software rasterisers pay for it out of all proportion: twice the time of a whole frame with 4 on llvmpipe.
float affordable_anisotropy() {
  const std::string_view renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const bool software = renderer.find("llvmpipe") != renderer.npos ||
                        renderer.find("softpipe") != renderer.npos ||
                        renderer.find("SwiftShader") != renderer.npos;
  return software ? 1 : kAnisotropy;
}

void set_sampling(GLuint name, const Texture& texture) {
  const float anisotropy = affordable_anisotropy();
  gl::texture_parameter(name, GL_TEXTURE_WRAP_S, static_cast<GLint>(wrap_mode(texture.wrap_u)));
  gl::texture_parameter(name, GL_TEXTURE_WRAP_T, static_cast<GLint>(wrap_mode(texture.wrap_v)));
  gl::texture_parameter(name, GL_TEXTURE_MAG_FILTER,
                        static_cast<GLint>(texture.nearest ? GL_NEAREST : GL_LINEAR));
  gl::texture_parameter(name, GL_TEXTURE_MIN_FILTER,
                        static_cast<GLint>(texture.nearest ? GL_NEAREST : GL_LINEAR_MIPMAP_LINEAR));
  if (texture.nearest || anisotropy <= 1 || !epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic"))
    return;
  float most = 1;
  glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &most);
  gl::texture_parameter(name, GL_TEXTURE_MAX_ANISOTROPY_EXT, std::min(most, anisotropy));
}

// A GL texture with all mip levels and its sampling state. Where `cutoff` is given, the texture is
// alpha-tested with it: each level then keeps the part of level 0 that passes the test, so that foliage does
// not thin out with distance (Castano, "Computing Alpha Mipmaps", 2010), and colours are averaged by their
// alpha. Errors: kInvalidArgument for a texture larger than the driver takes.
Result<gl::Texture> upload_texture(const Texture& texture, std::optional<float> cutoff) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (texture.width > largest || texture.height > largest) {
    return Status::invalid(fmt::format("a texture is {} x {}; this driver takes at most {} x {}",
                                       texture.width, texture.height, largest, largest));
  }
  const int levels = std::bit_width(static_cast<unsigned>(std::max(texture.width, texture.height)));
  gl::Texture handle = gl::Texture::create();
  const GLuint name = handle.get();
  const Extent extent = {texture.width, texture.height};
  gl::texture_storage(name, levels, texture.srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, extent);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl::texture_write(name, 0, extent, GL_RGBA, GL_UNSIGNED_BYTE, texture.rgba.data());
  set_sampling(name, texture);
  if (cutoff) {
    upload_tested_levels(name, levels, texture, *cutoff);
  } else {
    gl::texture_mipmaps(name);
  }
  return handle;
}

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

struct Attribute {
  GLuint location;
  GLint components;
  std::size_t offset;
};

// For the vertex array that is bound.
void describe(GLuint slot, std::initializer_list<Attribute> attributes) {
  for (const Attribute& attribute : attributes) {
    glEnableVertexAttribArray(attribute.location);
    glVertexAttribFormat(attribute.location, attribute.components, GL_FLOAT, GL_FALSE,
                         static_cast<GLuint>(attribute.offset));
    glVertexAttribBinding(attribute.location, slot);
  }
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

gl::VertexArray surface_vertex_array(const GpuScene& gpu) {
  gl::VertexArray array = gl::VertexArray::create();
  glBindVertexArray(array.get());
  describe(kVertexSlot, {{0, 3, offsetof(Vertex, position)},
                         {1, 3, offsetof(Vertex, normal)},
                         {2, 2, offsetof(Vertex, uv)},
                         {3, 4, offsetof(Vertex, colour)}});
  describe(kInstanceSlot, {{4, 4, 0}, {5, 4, 16}, {6, 4, 32}, {7, 4, 48}, {8, 4, 64}, {9, 4, 80}});
  glBindVertexBuffer(kVertexSlot, gpu.vertices(), 0, sizeof(Vertex));
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, gpu.indices());
  glVertexBindingDivisor(kInstanceSlot, 1);
  glBindVertexArray(0);
  return array;
}

gl::VertexArray particle_vertex_array() {
  gl::VertexArray array = gl::VertexArray::create();
  static_assert(offsetof(Particle, radius) == offsetof(Particle, position) + 12, "read as one vec4");
  glBindVertexArray(array.get());
  describe(kInstanceSlot, {{0, 4, offsetof(Particle, position)}, {1, 4, offsetof(Particle, colour)}});
  glVertexBindingDivisor(kInstanceSlot, 1);
  glBindVertexArray(0);
  return array;
}

void draw_mesh(const MeshRange& mesh, GLuint instances, GLintptr offset, std::uint32_t first,
               std::uint32_t count) {
  const auto start = offset + static_cast<GLintptr>(first * sizeof(InstanceData));
  glBindVertexBuffer(kInstanceSlot, instances, start, sizeof(InstanceData));
  const auto indices = static_cast<std::uintptr_t>(mesh.first_index) * sizeof(std::uint32_t);
  glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(mesh.index_count), GL_UNSIGNED_INT,
                          reinterpret_cast<const void*>(indices), static_cast<GLsizei>(count));
}

}  // namespace quincunx::scenes
