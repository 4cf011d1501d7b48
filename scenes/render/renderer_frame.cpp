// SPDX-License-Identifier: MIT
// The processor's part of a frame: matrices, places, lists, uploads.
#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

#include "render/gl_program.h"
#include "render/renderer_impl.h"
#include "render/truth_targets.h"
#include "render/vertex_input.h"

namespace quincunx::scenes {
namespace {

constexpr int kParticleLooks = 64;         // times over the duration at which particles are counted
constexpr std::size_t kParticleSpare = 2;  // room for more than was counted

std::array<glm::vec4, 3> rows_of(const glm::mat4& affine) {
  const glm::mat4 rows = glm::transpose(affine);
  return {rows[0], rows[1], rows[2]};
}

// As frame.glsl numbers them.
float curve_of(ToneMap tone_map) {
  switch (tone_map) {
    case ToneMap::kClamp:
      return 1;
    case ToneMap::kReinhard:
      return 2;
    case ToneMap::kAces:
      return 3;
  }
  return 1;
}

std::size_t most_particles(const Scene& scene, std::vector<Particle>& scratch) {
  std::size_t most = 0;
  for (int i = 0; scene.particles && i <= kParticleLooks; ++i) {
    scratch.clear();
    scene.particles(scene.duration * i / kParticleLooks, scratch);
    most = std::max(most, scratch.size());
  }
  return most;
}

}  // namespace

Renderer::Impl::Impl(const Scene& source) : scene(source), layout(lay_out(scene)) {
  for (const PlacedInstance& instance : layout.instances) {
    const auto rows = rows_of(instance.transform);
    placed.push_back({rows, rows});
    boxes.push_back(instance.reach);
  }
}

Status Renderer::Impl::create_programs() {
  const auto link = [](gl::Program& to, const char* vertex, const char* fragment,
                       std::vector<std::string> defines) {
    Result<gl::Program> program = link_program(vertex, fragment, defines);
    if (program.ok()) to = std::move(program).value();
    return program.status();
  };
  const auto link_both = [&](SurfacePrograms& to, const char* vertex, const char* fragment,
                             std::vector<std::string> defines) {
    if (Status status = link(to.plain, vertex, fragment, defines); !status.ok()) return status;
    defines.emplace_back("VELOCITY");
    return link(to.with_velocity, vertex, fragment, defines);
  };
  surface_programs.resize(layout.programs.size());
  for (std::size_t i = 0; i < layout.programs.size(); ++i) {
    const SurfaceFeatures& features = layout.programs[i];
    const Status status =
        features.blend
            ? link(surface_programs[i].plain, "surface.vert.glsl", "surface.frag.glsl", features.defines())
            : link_both(surface_programs[i], "surface.vert.glsl", "surface.frag.glsl", features.defines());
    if (!status.ok()) return status;
  }
  std::vector<std::string> sky_defines;
  if (scene.sky.background == Background::kPlain) sky_defines.emplace_back("PLAIN");
  if (scene.sky.background == Background::kNone) sky_defines.emplace_back("TRANSPARENT");
  if (!scene.sky.has_velocity) sky_defines.emplace_back("MOTIONLESS");
  if (Status status = link_both(sky_programs, "sky.vert.glsl", "sky.frag.glsl", sky_defines); !status.ok()) {
    return status;
  }
  if (!scene.particles) return {};
  Result<ParticleLayer> layer = ParticleLayer::create();
  if (!layer.ok()) return layer.status();
  particle_layer = std::move(layer).value();
  return link(particle_program, "particle.vert.glsl", "particle.frag.glsl", {});
}

void Renderer::Impl::create_streams() {
  frame_stream = StreamBuffer(sizeof(FrameBlock));
  instance_stream = StreamBuffer(layout.pieces.size() * sizeof(InstanceData));
  surface_array = surface_vertex_array(gpu);
  if (!scene.particles) return;
  const std::size_t most = most_particles(scene, particles);
  particle_stream = StreamBuffer(kParticleSpare * most * sizeof(Particle));
  particles.reserve(kParticleSpare * most);
  particle_array = particle_vertex_array();
}

float Renderer::Impl::aspect_of(const FrameView& view) const {
  if (view.aspect > 0) return view.aspect;
  return static_cast<float>(view.render.width) / static_cast<float>(view.render.height);
}

Renderer::Impl::View Renderer::Impl::view_at(const FrameView& view) const {
  const float aspect = aspect_of(view);
  View matrices;
  matrices.camera = scene.camera(view.seconds);
  matrices.now = view_of(matrices.camera, aspect, view.window);
  matrices.before = view_of(scene.camera(view.previous_seconds), aspect, view.previous_window);
  return matrices;
}

void Renderer::Impl::place_instances(const FrameView& view, bool with_previous) {
  for (std::size_t i = 0; i < layout.instances.size(); ++i) {
    if (!layout.instances[i].moves) continue;
    const Motion& motion = scene.instances[i].motion;
    const glm::mat4 now = motion(view.seconds);
    placed[i].world = rows_of(now);
    placed[i].previous = with_previous ? rows_of(motion(view.previous_seconds)) : placed[i].world;
    boxes[i] = transformed(layout.meshes[static_cast<std::size_t>(layout.instances[i].mesh)].box, now);
  }
  particles.clear();
  if (scene.particles) scene.particles(view.seconds, particles);
}

FrameBlock Renderer::Impl::frame_block(const View& view, const FrameView& frame, bool encoded) const {
  const auto width = static_cast<float>(frame.render.width);
  const auto height = static_cast<float>(frame.render.height);
  const glm::dmat4& camera = view.now.world_from_camera;
  FrameBlock block;
  block.clip_from_world = view.now.clip_from_world();
  block.previous_clip_from_world = view.before.clip_from_world();
  block.clip_to_previous_clip = clip_to_previous_clip(view.now, view.before);
  block.shadow_from_world = layout.shadow.shadow_from_world;
  block.jitter = {frame.jitter.x, frame.jitter.y, 1 / width, 1 / height};
  // To sample at centre + jitter, everything moves by -jitter; y runs up in clip space and down in pixels.
  block.jitter_clip = {-2 * frame.jitter.x / width, 2 * frame.jitter.y / height, 0, 0};
  block.camera_position = glm::vec4(glm::vec3(camera[3]), frame.lod_bias);
  block.camera_right = glm::vec4(glm::normalize(glm::vec3(camera[0])), 0);
  block.camera_up = glm::vec4(glm::normalize(glm::vec3(camera[1])), 0);
  const glm::dvec3 centre = view.now.camera_from_clip[3];  // of the window, seen from the camera
  block.ray_centre = glm::vec4(glm::vec3(glm::dmat3(camera) * glm::dvec3(centre.x, centre.y, -1)), 0);
  block.ray_x = glm::vec4(glm::vec3(camera[0] * view.now.camera_from_clip[0][0]), 0);
  block.ray_y = glm::vec4(glm::vec3(camera[1] * view.now.camera_from_clip[1][1]), 0);
  const bool has_sun = scene.sun.direction != glm::vec3(0);
  block.to_sun = glm::vec4(has_sun ? -glm::normalize(scene.sun.direction) : glm::vec3(0, 1, 0), 0);
  const int side = shadow_side(frame.shadow_scale);
  const float part = static_cast<float>(side) / kShadowTexels;
  block.shadow = {part, (static_cast<float>(side) + 0.5f) / kShadowTexels, 0, 0};
  block.sun_irradiance = glm::vec4(has_sun ? scene.sun.irradiance : glm::vec3(0),
                                   layout.shadow.enabled ? layout.shadow.texel_metres / part : 0);
  const double radius = scene.sky.sun_radius;
  block.sun_radiance = glm::vec4(scene.sky.sun_radiance, 2 * std::pow(std::sin(radius / 2), 2));
  block.zenith = glm::vec4(scene.sky.zenith, 0);
  block.horizon = glm::vec4(scene.sky.horizon, 0);
  block.ground = glm::vec4(scene.sky.ground, 0);
  if (encoded) block.display = {frame.display.exposure, curve_of(frame.display.tone_map), 0, 0};
  return block;
}

void Renderer::Impl::make_lists(const View& view, const FrameView& frame) {
  const glm::mat4 matrix = view.now.clip_from_world();
  const float jitter = std::max(std::abs(frame.jitter.x), std::abs(frame.jitter.y)) + 1;
  const float margin = 2 * jitter / static_cast<float>(std::min(frame.render.width, frame.render.height));
  list.build_view(layout, placed, boxes, Frustum(matrix, margin), glm::vec3(view.now.world_from_camera[3]),
                  frame.least_size * 2 * std::tan(view.camera.vertical_fov / 2), particles);
}

void Renderer::Impl::upload_frame(const FrameBlock& block) {
  const GLintptr offset = frame_stream.write(&block, sizeof(block));
  glBindBufferRange(GL_UNIFORM_BUFFER, kFrameBinding, frame_stream.get(), offset, sizeof(block));
  const std::vector<InstanceData>& data = list.instances();
  instance_offset = instance_stream.write(data.data(), data.size() * sizeof(InstanceData));
  if (particles.empty()) return;
  // More than ever seen while counting: grow once, well ahead.
  if (particles.size() * sizeof(Particle) > particle_stream.frame_bytes()) {
    particle_stream = StreamBuffer(kParticleSpare * particles.size() * sizeof(Particle));
  }
  particle_offset = particle_stream.write(particles.data(), particles.size() * sizeof(Particle));
}

}  // namespace quincunx::scenes
