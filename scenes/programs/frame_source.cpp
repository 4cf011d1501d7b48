// SPDX-License-Identifier: MIT
#include "programs/frame_source.h"

#include <algorithm>

#include "catalog/scene_catalog.h"

namespace quincunx::scenes {
namespace {

// What pixels hold that no one has drawn is no part of the frame: zeros are read instead.
void blank_unshaded(gl::TargetPixels& pixels, int parity) {
  const auto width = static_cast<std::size_t>(pixels.render.width);
  for (std::size_t i = 0; i < static_cast<std::size_t>(pixels.render.area()); ++i) {
    if ((i % width + i / width) % 2 == static_cast<std::size_t>(parity)) continue;
    const auto blank = [i](auto& values, std::size_t channels) {
      if (!values.empty())
        std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(i * channels), channels, 0);
    };
    blank(pixels.colour, 4);
    blank(pixels.codes, 4);
    blank(pixels.depth, 1);
    blank(pixels.velocity, 2);
    blank(pixels.reactive, 1);
  }
}

}  // namespace

Result<std::unique_ptr<FrameSource>> FrameSource::create(const FrameSourceSettings& settings) {
  auto source = std::unique_ptr<FrameSource>(new FrameSource(settings));
  if (Status status = source->open_sequence(); !status.ok()) return status;
  if (Status status = source->open_stage(); !status.ok()) return status;
  if (Status status = source->open_focus(); !status.ok()) return status;
  return source;
}

Result<std::unique_ptr<FrameSource>> FrameSource::another(const SequenceSettings& sequence,
                                                          const std::optional<PartsSettings>& parts,
                                                          const std::optional<FocusOptions>& focus) const {
  auto source = std::unique_ptr<FrameSource>(new FrameSource(settings_));
  source->settings_.sequence = sequence;
  if (parts) source->settings_.parts = *parts;
  if (focus) source->settings_.focus = *focus;
  if (Status status = source->open_sequence(); !status.ok()) return status;
  source->stage_ = stage_;
  if (Status status = source->open_focus(); !status.ok()) return status;
  return source;
}

Status FrameSource::open_sequence() {
  auto sequence = FrameSequence::create(settings_.sequence);
  if (!sequence.ok()) return sequence.status();
  sequence_ = sequence.value();
  outputs_ = settings_.sequence.outputs;
  return {};
}

Status FrameSource::open_stage() {
  stage_ = std::make_shared<Stage>();
  auto scene = open_scene(settings_.scene, settings_.seed);
  if (!scene.ok()) return scene.status();
  stage_->scene = std::move(scene).value();

  Device::list();  // some drivers want OpenCL enumerated before a GL context exists
  auto context = gl::EglContext::create(settings_.platform, settings_.api);
  if (!context.ok()) return context.status();
  stage_->context = std::move(context).value();
  auto device = gl::open_device(*stage_->context, settings_.device, settings_.interop);
  if (!device.ok()) return device.status();
  stage_->device = device.value();
  auto renderer = Renderer::create(stage_->scene);
  if (!renderer.ok()) return renderer.status();
  stage_->renderer = std::move(renderer).value();
  return {};
}

Status FrameSource::open_focus() {
  if (!settings_.focus.target) return {};
  auto focus = FocusFeed::create(settings_.focus, scene(), settings_.sequence);
  if (!focus.ok()) return focus.status();
  focus_ = std::move(focus).value();
  return {};
}

Result<ResolvePlan> FrameSource::connect(const ResolveSettings& resolve, HandOver hand_over) {
  auto plans = connect_all({resolve}, hand_over);
  if (!plans.ok()) return plans.status();
  return plans->front();
}

Result<std::vector<ResolvePlan>> FrameSource::connect_all(std::vector<ResolveSettings> resolves,
                                                          HandOver hand_over) {
  const SceneNeeds needs = needs_of(scene());
  gl::BridgeSettings bridging;
  bridging.interop = settings_.interop;
  bridging.target = sequence_->target();
  bridging.output = sequence_->output();
  bridging.targets = resolves.front().targets;
  bridging.colour = resolves.front().colour;
  display_ = {.exposure = exposure(), .tone_map = resolves.front().tone_map};
  bridging.depth = bridging.velocity = bridging.reactive = hand_over == HandOver::kEvery;
  for (ResolveSettings& resolve : resolves) {
    resolve.output = bridging.output;
    resolve.least_output = outputs_ ? outputs_->least() : Extent();
    resolve.target = bridging.target;
    resolve.particle_target = particle_target();
    resolve.targets = bridging.targets;
    if (focus_) resolve.focus = focus_->settings();
    const auto plan = plan_for(needs, resolve);
    if (!plan.ok()) return plan.status();
    bridging.checkerboard |= resolve.shading == Shading::kCheckerboard;
    bridging.depth |= plan->reads_depth;
    bridging.velocity |= plan->velocity == VelocitySource::kTarget;
    bridging.reactive |= plan->reads_reactive;
  }
  auto bridge = gl::Bridge::create(context(), device(), bridging);
  if (!bridge.ok()) return bridge.status();
  bridge_ = std::move(bridge).value();
  if (Status status = open_parts(bridging); !status.ok()) return status;

  std::vector<ResolvePlan> plans;
  for (ResolveSettings& resolve : resolves) {
    resolve.storage = bridge_->storage();
    const auto plan = plan_for(needs, resolve);
    if (!plan.ok()) return plan.status();
    plans.push_back(plan.value());
  }
  if (!focus_) return plans;
  if (Status status = focus_->connect(context(), device(), bridging, plans); !status.ok()) return status;
  return plans;
}

Extent FrameSource::particle_target() const {
  return scene().particles ? scenes::particle_target(settings_.parts, sequence_->target()) : Extent();
}

// Particles pass as frames do, by a bridge of the same kind, whose own picture nobody makes.
Status FrameSource::open_parts(const gl::BridgeSettings& bridging) {
  PartsSettings settings = settings_.parts;
  if (!scene().particles) settings.particles.reset();
  auto parts = PartScales::create(settings, sequence_->target());
  if (!parts.ok()) return parts.status();
  parts_ = std::move(parts).value();
  particle_bridge_.reset();
  if (!settings.particles) return {};
  gl::BridgeSettings own = bridging;
  own.target = particle_target();
  own.output = {1, 1};
  own.depth = true;
  own.velocity = own.checkerboard = false;
  auto bridge = gl::Bridge::create(context(), device(), own);
  if (!bridge.ok()) return bridge.status();
  particle_bridge_ = std::move(bridge).value();
  return {};
}

gl::Bridge::Memory FrameSource::memory() const {
  gl::Bridge::Memory memory = bridge_->memory();
  if (!particle_bridge_) return memory;
  const gl::Bridge::Memory particles = particle_bridge_->memory();
  memory.gl_bytes += particles.gl_bytes;
  memory.opencl_bytes += particles.opencl_bytes;
  return memory;
}

std::uint64_t FrameSource::bytes_in() const {
  return bridge_->traffic().bytes_in + (particle_bridge_ ? particle_bridge_->traffic().bytes_in : 0) +
         (focus() != nullptr ? focus_->bridge().traffic().bytes_in : 0);
}

Status FrameSource::draw(std::int64_t index, bool keep_targets) {
  return draw(index, sequence_->at(index), keep_targets);
}

Status FrameSource::draw(std::int64_t index, const FrameView& view, bool keep_targets) {
  if (Status status = begin(index, view, keep_targets); !status.ok()) return status;
  return submit();
}

Status FrameSource::begin(std::int64_t index, bool keep_targets) {
  return begin(index, sequence_->at(index), keep_targets);
}

Status FrameSource::begin(std::int64_t index, const FrameView& view, bool keep_targets) {
  const bool cut = is_cut(scene(), view.previous_seconds, view.seconds);
  const Extent output = outputs_ ? outputs_->next(view.render) : sequence_->output();
  DrawnFrame frame = {.index = index, .output = output, .view = view, .reset = cut || index == 0};
  if (cut) frame.view.previous_seconds = view.seconds;
  frame.view.display = display_;
  parts_->choose(frame.view);
  const int slot = static_cast<int>(index % bridge_->slots());
  auto targets = bridge_->begin_draw(slot, frame.view.render);
  if (!targets.ok()) return targets.status();
  auto particles = begin_particles(slot, frame.view);
  if (!particles.ok()) return particles.status();
  const Status drawn = renderer().draw(*targets.value(), frame.view, parts_->parts(index, particles.value()));
  if (!drawn.ok()) return drawn;
  parts_->learn();
  if (keep_targets) frame.targets = gl::read_targets(*targets.value(), frame.view.render);
  if (keep_targets && view.parity) blank_unshaded(frame.targets, *view.parity);
  if (keep_targets && particle_bridge_)
    frame.particles = gl::read_targets(*particles.value(), frame.view.particles);
  drawn_.push_back(std::move(frame));
  if (!focus_) return {};
  DrawnFrame& last = drawn_.back();
  return focus_->begin(renderer(), index, last.view, last.reset, keep_targets ? &last.focus : nullptr);
}

Result<const gl::RenderTargets*> FrameSource::begin_particles(int slot, const FrameView& view) {
  if (!particle_bridge_) return static_cast<const gl::RenderTargets*>(nullptr);
  return particle_bridge_->begin_draw(slot, view.particles);
}

Status FrameSource::submit() {
  const int slot = static_cast<int>(drawn_.back().index % bridge_->slots());
  if (Status status = bridge_->submit(slot); !status.ok()) return status;
  if (particle_bridge_) {
    if (Status status = particle_bridge_->submit(slot); !status.ok()) return status;
  }
  return focus_ ? focus_->submit() : Status();
}

void FrameSource::release() {
  drawn_.pop_front();
  if (focus_) focus_->release();
}

FrameReport FrameSource::dispatch(ResolveService& service, const FrameInputs& inputs,
                                  const FrameOutputs& outputs) const {
  const FocusInputs* const focused = service.plan().has_focus() ? focus() : nullptr;
  return focused != nullptr ? service.dispatch(inputs, *focused, outputs) : service.dispatch(inputs, outputs);
}

Result<FrameInputs> FrameSource::acquire() {
  const DrawnFrame& frame = drawn_.front();
  if (focus_) {
    if (Status status = focus_->acquire(*stage_->renderer); !status.ok()) return status;
  }
  auto shared = bridge_->acquire(static_cast<int>(frame.index % bridge_->slots()));
  if (!shared.ok()) return shared.status();
  FrameInputs inputs;
  inputs.colour = shared->colour;
  inputs.depth = shared->depth;
  inputs.velocity = shared->velocity;
  inputs.reactive = shared->reactive;
  inputs.render = frame.view.render;
  inputs.output = frame.output;
  inputs.jitter = frame.view.jitter;
  inputs.parity = frame.view.parity.value_or(0);
  inputs.camera = stage_->renderer->camera_motion(frame.view);
  inputs.exposure = exposure();
  inputs.frame_index = static_cast<std::uint64_t>(frame.index);
  inputs.reset = frame.reset;
  if (!particle_bridge_) return inputs;
  auto particles = particle_bridge_->acquire(static_cast<int>(frame.index % bridge_->slots()));
  if (!particles.ok()) return particles.status();
  inputs.particle_colour = particles->colour;
  inputs.particle_depth = particles->depth;
  inputs.particle_reactive = particles->reactive;
  inputs.particle_render = frame.view.particles;
  return inputs;
}

}  // namespace quincunx::scenes
