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

// Of the vertex array that is bound.
void describe(GLuint slot, std::initializer_list<Attribute> attributes) {
  for (const Attribute& attribute : attributes) {
    glEnableVertexAttribArray(attribute.location);
    glVertexAttribFormat(attribute.location, attribute.components, GL_FLOAT, GL_FALSE,
                         static_cast<GLuint>(attribute.offset));
    glVertexAttribBinding(attribute.location, slot);
  }
}

}  // namespace

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
