// SPDX-License-Identifier: MIT
#include "render/renderer.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "quincunx_gl/gl_calls.h"
#include "render/gl_program.h"
#include "render/gl_state.h"
#include "render/renderer_impl.h"
#include "render/truth_targets.h"
#include "render/vertex_input.h"
#include "scene_check.h"

namespace quincunx::scenes {
namespace {

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

}  // namespace

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

}  // namespace quincunx::scenes
