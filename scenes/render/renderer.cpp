// SPDX-License-Identifier: MIT
#include "render/renderer.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "quincunx_gl/gl_calls.h"
#include "render/gl_program.h"
#include "render/gl_state.h"
#include "render/gpu_scene.h"
#include "render/renderer_impl.h"
#include "scene.h"

namespace quincunx::scenes {
namespace {

constexpr GLint kFrameExtent = 0;  // uniforms of particle_depth.frag
constexpr GLint kExtent = 1;
constexpr GLint kParity = 2;
constexpr GLint kEveryPixel = -1;

Status check_particles(const Scene& scene, const FrameView& view, const FrameParts& parts) {
  if (view.particles == Extent()) return {};
  if (!scene.particles) return Status::invalid("FrameView::particles is given, but the scene has none");
  if (parts.particles == nullptr)
    return Status::invalid("FrameView::particles is given, but FrameParts::particles is missing");
  const Extent own = view.particles, extent = parts.particles->extent();
  const bool fits = own.width >= 1 && own.height >= 1 &&
                    own.width <= std::min(view.render.width, extent.width) &&
                    own.height <= std::min(view.render.height, extent.height);
  if (fits) return {};
  return Status::invalid(
      fmt::format("FrameView::particles is {} x {}; it must lie between 1 x 1 and both the frame's {} x {} "
                  "and the particle "
                  "targets' {} x {}",
                  own.width, own.height, view.render.width, view.render.height, extent.width, extent.height));
}

Status check_view(const gl::RenderTargets& targets, const FrameView& view) {
  const Extent extent = targets.extent();
  const bool fits = view.render.width >= 1 && view.render.height >= 1 && view.render.width <= extent.width &&
                    view.render.height <= extent.height;
  if (!fits) {
    return Status::invalid(
        fmt::format("FrameView::render is {} x {}; it must lie between 1 x 1 and the targets' {} x {}",
                    view.render.width, view.render.height, extent.width, extent.height));
  }
  const bool finite = std::isfinite(view.jitter.x) && std::isfinite(view.jitter.y) &&
                      std::isfinite(view.seconds) && std::isfinite(view.previous_seconds) &&
                      std::isfinite(view.lod_bias) && std::isfinite(view.aspect) && view.aspect >= 0 &&
                      std::isfinite(view.least_size) && view.least_size >= 0 &&
                      std::isfinite(view.shadow_age) && view.shadow_age >= 0 &&
                      std::isfinite(view.display.exposure) && view.display.exposure > 0;
  if (!finite) {
    return Status::invalid(
        "FrameView::jitter, seconds, previous_seconds, lod_bias, aspect, least_size, shadow_age and "
        "display.exposure must be finite, the last four not negative, and the exposure not 0");
  }
  if (!(view.shadow_scale >= kLeastPartScale && view.shadow_scale <= 1)) {
    return Status::invalid(fmt::format("FrameView::shadow_scale is {}; it must lie within [{}, 1]",
                                       view.shadow_scale, kLeastPartScale));
  }
  for (const ViewWindow& window : {view.window, view.previous_window}) {
    if (window.size.x > 0 && window.size.y > 0 && std::isfinite(window.size.x + window.size.y) &&
        std::isfinite(window.corner.x + window.corner.y))
      continue;
    return Status::invalid("FrameView::window and previous_window must be finite and not empty");
  }
  if (view.parity && !targets.has_checkerboard())
    return Status::invalid("FrameView::parity is given, but the targets have no checkerboard");
  if (view.parity && *view.parity != 0 && *view.parity != 1)
    return Status::invalid(fmt::format("FrameView::parity is {}; it must be 0 or 1", *view.parity));
  return {};
}

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

Result<ParticleLayer> ParticleLayer::create() {
  Result<gl::Program> program = link_program("sky.vert.glsl", "particle_depth.frag.glsl", {});
  if (!program.ok()) return program.status();
  ParticleLayer layer;
  layer.program_ = std::move(program).value();
  layer.nothing_ = gl::VertexArray::create();
  return layer;
}

void ParticleLayer::begin(const gl::RenderTargets& frame, const FrameView& view,
                          const gl::RenderTargets& particles) const {
  const Extent extent = view.particles;
  clear_particles(particles, extent);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, particles.framebuffer());
  glViewport(0, 0, extent.width, extent.height);
  set_depth_only_state();
  glBindVertexArray(nothing_.get());
  const GLuint program = program_.get();
  glUseProgram(program);
  glProgramUniform2i(program, kFrameExtent, view.render.width, view.render.height);
  glProgramUniform2i(program, kExtent, extent.width, extent.height);
  glProgramUniform1i(program, kParity, view.parity.value_or(kEveryPixel));
  gl::bind_texture(0, frame.depth());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  gl::bind_texture(0, 0);
}

Renderer::Renderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Result<Renderer> Renderer::create(const Scene& scene) {
  if (Status status = check_scene(scene); !status.ok()) return status;
  auto impl = std::make_unique<Impl>(scene);
  Result<GpuScene> gpu = GpuScene::upload(impl->scene, impl->layout);
  if (!gpu.ok()) return gpu.status();
  impl->gpu = std::move(gpu).value();
  Result<ShadowMap> shadows = ShadowMap::create(impl->scene, impl->layout);
  if (!shadows.ok()) return shadows.status();
  impl->shadows = std::move(shadows).value();
  if (Status status = impl->create_programs(); !status.ok()) return status;
  impl->create_streams();
  return Renderer(std::move(impl));
}

Status Renderer::draw(const gl::RenderTargets& targets, const FrameView& view, const FrameParts& parts) {
  if (Status status = check_view(targets, view); !status.ok()) return status;
  if (Status status = check_particles(impl_->scene, view, parts); !status.ok()) return status;
  const bool velocity = targets.velocity() != 0;
  const bool apart = view.particles != Extent();
  const Impl::View matrices = impl_->view_at(view);
  impl_->place_instances(view, velocity);
  impl_->make_lists(matrices, view);
  const bool encoded = targets.colour_format() == PixelFormat::kRGBA8;
  impl_->upload_frame(impl_->frame_block(matrices, view, encoded));

  const DrawState state;
  glBindVertexArray(impl_->surface_array.get());
  impl_->draw_shadows(view, parts);
  clear_for_frame(targets, view.render);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, targets.framebuffer());
  glViewport(0, 0, view.render.width, view.render.height);
  if (view.parity) draw_checkerboard(*view.parity);
  impl_->draw_opaque(velocity);
  impl_->draw_sky(velocity);
  impl_->draw_blended(!apart);
  impl_->draw_faults(targets, view);
  if (apart) impl_->draw_particles_apart(targets, view, parts);
  return {};
}

CameraMotion Renderer::camera_motion(const FrameView& view) const {
  const Impl::View matrices = impl_->view_at(view);
  return camera_motion_between(matrices.now, matrices.before);
}

void Renderer::Impl::draw_batch(const Batch& batch, bool velocity) {
  const SurfacePrograms& programs = surface_programs[static_cast<std::size_t>(batch.program)];
  const MeshRange& part = layout.parts[static_cast<std::size_t>(batch.range)];
  const Bound wanted{velocity ? programs.with_velocity.get() : programs.plain.get(), part.material,
                     batch.light_set};
  if (wanted.program != bound.program) glUseProgram(wanted.program);
  if (wanted.material != bound.material) gpu.bind_material(wanted.material);
  if (wanted.light_set != bound.light_set) gpu.bind_light_set(wanted.light_set);
  bound = wanted;
  set_winding(batch.mirrored);
  draw_mesh(part, instance_stream.get(), instance_offset, batch.first, batch.count);
}

void Renderer::Impl::draw_shadows(const FrameView& view, const FrameParts& parts) {
  const int side = shadow_side(view.shadow_scale);
  const ShadowMap::Work work = shadows.work_for(layout, view.seconds, view.shadow_age, side);
  gl::PartTimer* const timer = work == ShadowMap::Work::kMoving ? parts.shadow_timer : nullptr;
  if (timer != nullptr) timer->begin(parts.frame, {side, side});
  shadows.update(work, layout, gpu, placed, view.seconds, side);
  if (timer != nullptr) timer->end();
}

void Renderer::Impl::draw_opaque(bool velocity) {
  set_opaque_state();
  gl::bind_texture(kShadowUnit, shadows.texture());
  bound = {};
  for (const Batch& batch : list.opaque())
    draw_batch(batch, velocity);
}

void Renderer::Impl::draw_sky(bool velocity) const {
  set_sky_state();
  glUseProgram(velocity ? sky_programs.with_velocity.get() : sky_programs.plain.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Renderer::Impl::draw_blended(bool with_particles) {
  if (list.blended().empty()) return;
  set_blended_state();
  bound = {};
  bool particles_bound = false;
  for (const Batch& batch : list.blended()) {
    if (batch.particles && !with_particles) continue;
    if (batch.particles != particles_bound) {
      glBindVertexArray(batch.particles ? particle_array.get() : surface_array.get());
      particles_bound = batch.particles;
    }
    if (!batch.particles) {
      draw_batch(batch, false);
      continue;
    }
    draw_particles(batch.first, batch.count);
    bound = {};
  }
}

void Renderer::Impl::draw_particles(std::size_t first, std::size_t count) const {
  const auto offset = particle_offset + static_cast<GLintptr>(first * sizeof(Particle));
  glBindVertexBuffer(kInstanceSlot, particle_stream.get(), offset, sizeof(Particle));
  glUseProgram(particle_program.get());
  glDisable(GL_CULL_FACE);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(count));
}

// All of them, farthest first, as make_lists() has sorted them.
void Renderer::Impl::draw_particles_apart(const gl::RenderTargets& frame, const FrameView& view,
                                          const FrameParts& parts) const {
  if (parts.particle_timer != nullptr) parts.particle_timer->begin(parts.frame, view.particles);
  particle_layer.begin(frame, view, *parts.particles);
  set_blended_state();
  if (!particles.empty()) {
    glBindVertexArray(particle_array.get());
    draw_particles(0, particles.size());
  }
  if (parts.particle_timer != nullptr) parts.particle_timer->end();
}

void Renderer::Impl::draw_faults(const gl::RenderTargets& targets, const FrameView& view) const {
  if (view.window != ViewWindow{}) return;  // they are of the picture's own targets
  const glm::ivec2 viewport(view.render.width, view.render.height);
  for (const Fault& fault : scene.faults) {
    if (!shows(scene, fault, view.previous_seconds, view.seconds)) continue;
    const glm::ivec2 corner(fault.place * glm::vec2(viewport));
    const int side = std::max(1, static_cast<int>(std::lround(fault.side * static_cast<float>(viewport.y))));
    fill_colour(targets, corner, glm::min(glm::ivec2(side), viewport - corner), fault.value);
  }
}

// The processor's part of a frame: matrices, places, lists, uploads.

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
  const glm::dvec3 centre = view.now.camera_from_clip[3];  // centre of the window, seen from the camera
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
