// SPDX-License-Identifier: MIT
// Vertex layouts. Buffer bindings: 0 per vertex, 1 per instance.
#pragma once

#include "quincunx_gl/handle.h"
#include "render/gpu_scene.h"

namespace quincunx::scenes {

inline constexpr GLuint kVertexSlot = 0;
inline constexpr GLuint kInstanceSlot = 1;

gl::VertexArray surface_vertex_array(const GpuScene& gpu);  // the instance buffer is bound per frame
gl::VertexArray particle_vertex_array();                    // the same

// One instanced draw of a mesh; the vertex array, program and material are bound. `instances`: a buffer of InstanceData
// from `offset` on, of which `count` from `first` on are drawn.
void draw_mesh(const MeshRange& mesh, GLuint instances, GLintptr offset, std::uint32_t first,
               std::uint32_t count);

}  // namespace quincunx::scenes
