// SPDX-License-Identifier: MIT
#include "frames/part_scales.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "quincunx/control/predictive_controller.h"
#include "render/view_math.h"

namespace quincunx::scenes {
namespace {

// Each change of the map's side draws again what stands still, so that there are few of them.
constexpr int kShadowStep = kShadowTexels / 16;

constexpr int kParticleStep = 2;  // pixels

Extent scaled(Extent extent, float scale) {
  const auto side = [scale](int whole) {
    return std::max(1, static_cast<int>(std::lround(static_cast<float>(whole) * scale)));
  };
  return {side(extent.width), side(extent.height)};
}

// Where times need a wait, one frame of so many is timed.
constexpr int kTimedFrames = 4;

// "0.5" or "held at 1.67 ms".
std::string text_of(const PartSettings& settings) {
  return settings.is_controlled() ? fmt::format("held at {:.3g} ms", settings.budget_ms)
                                  : fmt::format("{:.3g}", settings.scale);
}

Result<gl::PartTimer> part_timer() {
  const auto frames = gl::FrameTimer::create();
  if (!frames.ok()) return frames.status();
  return gl::PartTimer::create(frames->method(), kTimedFrames);
}

constexpr float kLeastSizePerLevel = 0.008f;  // six lines of 720
constexpr double kRounding = 0.5;             // part of a frame: times of frames are sums

}  // namespace

Result<PartController> PartController::create(Extent whole, int step, double budget_ms) {
  auto controller = make_predictive_controller({.ladder = {.output_extent = whole,
                                                           .min_scale = kLeastPartScale,
                                                           .max_scale = 1,
                                                           .order = AxisOrder::kBoth,
                                                           .step = step},
                                                .target_ms = budget_ms});
  if (!controller.ok()) return controller.status();
  return PartController(std::move(controller).value());
}

void PartController::learn(std::uint64_t frame, Extent extent, double ms) {
  static_cast<void>(controller_->observe({.frame = frame, .render_extent = extent, .gpu_ms = ms}));
}

std::string explain(const PartsSettings& settings, bool has_particles) {
  const PartSettings& shadow = settings.shadow;
  const int side = shadow_side(shadow.scale);
  std::string text =
      shadow.is_controlled()
          ? fmt::format("Shadow map     up to {0}x{0} texels, {1} by a controller of its own\n",
                        kShadowTexels, text_of(shadow))
          : fmt::format("Shadow map     {0}x{0} of {1}x{1} texels\n", side, kShadowTexels);
  if (!settings.particles) return text;
  if (!has_particles) return text + "Particles      none in this scene\n";
  return text +
         (settings.particles->is_controlled()
              ? fmt::format("Particles      up to the frame's viewport, {} by a controller of their own\n",
                            text_of(*settings.particles))
              : fmt::format("Particles      {} of the frame's viewport on each axis\n",
                            text_of(*settings.particles)));
}

Extent particle_target(const PartsSettings& settings, Extent target) {
  if (!settings.particles) return {};
  return settings.particles->is_controlled() ? target : scaled(target, settings.particles->scale);
}

void PartScales::Controlled::note(float scale) {
  least = std::min(least, scale);
  largest = std::max(largest, scale);
  sum += scale;
  ++count;
}

void PartScales::Controlled::learn() {
  while (const auto part = timer.poll())
    controller.learn(part->frame, part->render_extent, part->gpu_ms);
}

std::string PartScales::Controlled::range() const {
  if (count == 0) return "";
  return fmt::format("{:.3g} to {:.3g}, mean {:.3g}, ", least, largest, sum / static_cast<double>(count));
}

Result<PartScales> PartScales::create(const PartsSettings& settings, Extent target) {
  PartScales scales(settings);
  const auto control = [](std::optional<Controlled>& part, Extent whole, int step, double budget_ms) {
    auto controller = PartController::create(whole, step, budget_ms);
    if (!controller.ok()) return controller.status();
    auto timer = part_timer();
    if (!timer.ok()) return timer.status();
    part.emplace(Controlled{.controller = std::move(controller).value(), .timer = std::move(timer).value()});
    return Status();
  };
  if (settings.shadow.is_controlled()) {
    const Status status =
        control(scales.shadow_, {kShadowTexels, kShadowTexels}, kShadowStep, settings.shadow.budget_ms);
    if (!status.ok()) return status;
  }
  if (settings.particles && settings.particles->is_controlled()) {
    const Status status = control(scales.particles_, target, kParticleStep, settings.particles->budget_ms);
    if (!status.ok()) return status;
  }
  return scales;
}

void PartScales::choose(FrameView& view) {
  view.shadow_scale = settings_.shadow.scale;
  if (shadow_) {
    // The map is square: rungs between squares count as the smaller one.
    const Extent rung = shadow_->controller.next();
    view.shadow_scale = static_cast<float>(std::min(rung.width, rung.height)) / kShadowTexels;
    shadow_->note(view.shadow_scale);
  }
  if (!settings_.particles) return;
  view.particles = scaled(view.render, settings_.particles->scale);
  if (particles_) {
    const Extent rung = particles_->controller.next();
    view.particles = {std::min(rung.width, view.render.width), std::min(rung.height, view.render.height)};
    particles_->note(static_cast<float>(view.particles.width) / static_cast<float>(view.render.width));
  }
}

FrameParts PartScales::parts(std::int64_t index, const gl::RenderTargets* particle_targets) {
  return {.frame = static_cast<std::uint64_t>(index),
          .shadow_timer = shadow_ ? &shadow_->timer : nullptr,
          .particles = particle_targets,
          .particle_timer = particles_ ? &particles_->timer : nullptr};
}

void PartScales::learn() {
  if (shadow_) shadow_->learn();
  if (particles_) particles_->learn();
}

std::string PartScales::summary() const {
  const auto used = [](const char* part, const std::optional<Controlled>& controlled,
                       const PartSettings& settings) {
    return fmt::format("{} {}{}", part, controlled ? controlled->range() : "", text_of(settings));
  };
  const std::string text = used("shadow map", shadow_, settings_.shadow);
  return settings_.particles ? text + "; " + used("particles", particles_, *settings_.particles) : text;
}

Result<FrameDetail> FrameDetail::create() {
  auto follower = DetailFollower::create();
  if (!follower.ok()) return follower.status();
  return FrameDetail(follower.value());
}

void FrameDetail::follow(double area_fraction, FrameView& view) {
  const int level = follower_.observe(area_fraction);
  if (level == 0) return;
  const double frame_seconds = view.seconds - view.previous_seconds;
  view.least_size = kLeastSizePerLevel * static_cast<float>(level);
  view.shadow_age = (level + kRounding) * frame_seconds;
}

}  // namespace quincunx::scenes
