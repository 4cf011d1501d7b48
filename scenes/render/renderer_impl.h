// SPDX-License-Identifier: MIT
// The objects of a Renderer. For renderer.cpp and truth.cpp only.
#pragma once

#include <memory>
#include <vector>

#include "quincunx/status.h"
#include "quincunx_gl/handle.h"
#include "quincunx_gl/render_targets.h"
#include "render/draw_list.h"
#include "render/gl_state.h"
#include "render/gpu_scene.h"
#include "render/renderer.h"
#include "render/scene_layout.h"
#include "render/shadow_map.h"
#include "render/view_math.h"

namespace quincunx::scenes {

// The depth that hides particles which are drawn into a viewport of their own.
class ParticleLayer {
 public:
  static Result<ParticleLayer> create();

  // Makes the particles' viewport transparent black and gives it the frame's depth: of the samples that a texel covers,
  // the nearest one's and the farthest one's in turns, like the fields of a checkerboard, so that on both sides of an
  // edge there are texels of both surfaces. Leaves the framebuffer of the particles bound, its viewport set, and depth
  // state changed.
  void begin(const gl::RenderTargets& frame, const FrameView& view, const gl::RenderTargets& particles) const;

 private:
  gl::Program program_;
  gl::VertexArray nothing_;
};

// One sub-frame's target and the sum of all, in 32-bit float, at output extent (truth.cpp).
class TruthTargets {
 public:
  static Result<TruthTargets> create(Extent output);

  Extent extent() const { return frame_.extent(); }
  const gl::RenderTargets& frame() const { return frame_; }

  void clear();                     // the sum
  void add(float weight);           // weight * frame() to the sum
  std::vector<float> read() const;  // RGBA, top row first; waits for the GPU

 private:
  explicit TruthTargets(gl::RenderTargets frame);

  gl::RenderTargets frame_;
  gl::Texture sum_;
  gl::Framebuffer sum_framebuffer_;
  gl::Program program_;
  gl::VertexArray nothing_;
};

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
  // Objects that the last draw_batch() bound, to bind only what changes; -2: unknown.
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
