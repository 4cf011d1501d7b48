// SPDX-License-Identifier: MIT
// What a Renderer owns. For renderer.cpp and truth.cpp only.
#pragma once

#include <memory>
#include <vector>

#include "render/draw_list.h"
#include "render/gpu_scene.h"
#include "render/particle_layer.h"
#include "render/renderer.h"
#include "render/scene_layout.h"
#include "render/shadow_map.h"
#include "render/stream_buffer.h"
#include "render/view_math.h"

namespace quincunx::scenes {

class TruthTargets;

struct Renderer::Impl {
  // The programs of one SurfaceFeatures; blended surfaces write no velocity and have only the first.
  struct SurfacePrograms {
    gl::Program plain;
    gl::Program with_velocity;
  };
  struct View {
    Camera camera;
    ViewMatrices now;
    ViewMatrices before;
  };

  explicit Impl(const Scene& scene);
  Status create_programs();
  void create_streams();

  float aspect_of(const FrameView& view) const;
  View view_at(const FrameView& view) const;
  void place_instances(const FrameView& view, bool with_previous);
  FrameBlock frame_block(const View& view, const FrameView& frame, bool encoded) const;
  void make_lists(const View& view, const FrameView& frame);
  void upload_frame(const FrameBlock& block);

  void draw_shadows(const FrameView& view, const FrameParts& parts);
  void draw_opaque(bool velocity);
  void draw_sky(bool velocity) const;
  void draw_blended(bool with_particles);
  void draw_particles(std::size_t first, std::size_t count) const;
  void draw_particles_apart(const gl::RenderTargets& frame, const FrameView& view,
                            const FrameParts& parts) const;
  void draw_faults(const gl::RenderTargets& targets, const FrameView& view) const;
  void draw_batch(const Batch& batch, bool velocity);

  Scene scene;
  SceneLayout layout;
  GpuScene gpu;
  ShadowMap shadows;
  std::vector<SurfacePrograms> surface_programs;
  SurfacePrograms sky_programs;
  gl::Program particle_program;
  ParticleLayer particle_layer;
  gl::VertexArray surface_array;
  gl::VertexArray particle_array;
  StreamBuffer frame_stream;
  StreamBuffer instance_stream;
  StreamBuffer particle_stream;
  // What the last draw_batch() bound, to bind only what changes; -2: unknown.
  struct Bound {
    GLuint program = 0;
    int material = -2;
    int light_set = -2;
  };
  Bound bound;
  GLintptr instance_offset = 0;
  GLintptr particle_offset = 0;

  std::vector<InstanceData> placed;
  std::vector<Bounds> boxes;
  std::vector<Particle> particles;
  DrawList list;

  std::unique_ptr<TruthTargets> truth;  // made by the first render_truth(), kept for the next
};

}  // namespace quincunx::scenes
