// SPDX-License-Identifier: MIT
#include "render/vertex_input.h"

#include <epoxy/gl.h>

#include <cstddef>
#include <initializer_list>

#include "render/frame_block.h"

namespace quincunx::scenes {
namespace {

struct Attribute {
  GLuint location;
  GLint components;
  std::size_t offset;
};

void describe(GLuint array, GLuint slot, std::initializer_list<Attribute> attributes) {
  for (const Attribute& attribute : attributes) {
    glEnableVertexArrayAttrib(array, attribute.location);
    glVertexArrayAttribFormat(array, attribute.location, attribute.components, GL_FLOAT, GL_FALSE,
                              static_cast<GLuint>(attribute.offset));
    glVertexArrayAttribBinding(array, attribute.location, slot);
  }
}

}  // namespace

gl::VertexArray surface_vertex_array(const GpuScene& gpu) {
  gl::VertexArray array = gl::VertexArray::create();
  const GLuint name = array.get();
  describe(name, kVertexSlot,
           {{0, 3, offsetof(Vertex, position)},
            {1, 3, offsetof(Vertex, normal)},
            {2, 2, offsetof(Vertex, uv)},
            {3, 4, offsetof(Vertex, colour)}});
  describe(name, kInstanceSlot, {{4, 4, 0}, {5, 4, 16}, {6, 4, 32}, {7, 4, 48}, {8, 4, 64}, {9, 4, 80}});
  glVertexArrayVertexBuffer(name, kVertexSlot, gpu.vertices(), 0, sizeof(Vertex));
  glVertexArrayElementBuffer(name, gpu.indices());
  glVertexArrayBindingDivisor(name, kInstanceSlot, 1);
  return array;
}

gl::VertexArray particle_vertex_array() {
  gl::VertexArray array = gl::VertexArray::create();
  static_assert(offsetof(Particle, radius) == offsetof(Particle, position) + 12, "read as one vec4");
  describe(array.get(), kInstanceSlot,
           {{0, 4, offsetof(Particle, position)}, {1, 4, offsetof(Particle, colour)}});
  glVertexArrayBindingDivisor(array.get(), kInstanceSlot, 1);
  return array;
}

void draw_mesh(const MeshRange& mesh, std::uint32_t first_instance, std::uint32_t count) {
  const auto offset = static_cast<std::uintptr_t>(mesh.first_index) * sizeof(std::uint32_t);
  glDrawElementsInstancedBaseVertexBaseInstance(
      GL_TRIANGLES, static_cast<GLsizei>(mesh.index_count), GL_UNSIGNED_INT,
      reinterpret_cast<const void*>(offset), static_cast<GLsizei>(count), mesh.base_vertex, first_instance);
}

}  // namespace quincunx::scenes
