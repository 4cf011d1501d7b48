// SPDX-License-Identifier: MIT
#include "frames/frame_source.h"

#include <fmt/format.h>

#include <algorithm>

#include "catalog/scene_catalog.h"

namespace quincunx::scenes {
namespace {

// Sets the pixels that nobody has drawn to zeros: their contents are no part of the frame.
void blank_unshaded(gl::TargetPixels& pixels, int parity) {
  const auto width = static_cast<std::size_t>(pixels.render_extent.width);
  for (std::size_t i = 0; i < static_cast<std::size_t>(pixels.render_extent.area()); ++i) {
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
  auto context = gl::Context::create(settings_.platform, settings_.api);
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
  auto focus = FocusRegion::create(settings_.focus, scene(), settings_.sequence);
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
  bridging.target_extent = sequence_->target();
  bridging.output_extent = sequence_->output();
  bridging.targets = resolves.front().targets.placement;
  bridging.colour = resolves.front().colour;
  display_ = {.exposure = exposure(), .tone_map = resolves.front().output.tone_map};
  bridging.depth = bridging.velocity = bridging.reactive = hand_over == HandOver::kEvery;
  for (ResolveSettings& resolve : resolves) {
    resolve.output_extent = bridging.output_extent;
    resolve.output.min_extent = outputs_ ? outputs_->min_output() : Extent();
    resolve.target_extent = bridging.target_extent;
    resolve.targets.particle_extent = particle_target();
    resolve.targets.placement = bridging.targets;
    if (focus_) resolve.focus = focus_->settings();
    const auto plan = plan_for(needs, resolve);
    if (!plan.ok()) return plan.status();
    bridging.checkerboard |= resolve.targets.shading == Shading::kCheckerboard;
    bridging.depth |= plan->reads_depth;
    bridging.velocity |= plan->velocity == VelocitySource::kTarget;
    bridging.reactive |= plan->reads_reactive;
  }
  feeds_.clear();
  if (Status status = open_feed(Feed::Kind::kPicture, bridging); !status.ok()) return status;
  if (Status status = open_parts(bridging); !status.ok()) return status;

  std::vector<ResolvePlan> plans;
  for (ResolveSettings& resolve : resolves) {
    resolve.targets.storage = bridge().storage();
    const auto plan = plan_for(needs, resolve);
    if (!plan.ok()) return plan.status();
    plans.push_back(plan.value());
  }
  if (Status status = open_focus_feed(bridging, plans); !status.ok()) return status;
  return plans;
}

Extent FrameSource::particle_target() const {
  return scene().particles ? scenes::particle_target(settings_.parts, sequence_->target()) : Extent();
}

Status FrameSource::open_feed(Feed::Kind kind, const gl::BridgeSettings& bridging) {
  auto bridge = gl::Bridge::create(context(), device(), bridging);
  if (!bridge.ok()) return bridge.status();
  feeds_.push_back({kind, std::move(bridge).value()});
  return {};
}

// Particles pass as frames do, by a bridge of the same kind, whose own picture nobody makes.
Status FrameSource::open_parts(const gl::BridgeSettings& bridging) {
  PartsSettings settings = settings_.parts;
  if (!scene().particles) settings.particles.reset();
  auto parts = PartScales::create(settings, sequence_->target());
  if (!parts.ok()) return parts.status();
  parts_ = std::move(parts).value();
  if (!settings.particles) return {};
  gl::BridgeSettings own = bridging;
  own.target_extent = particle_target();
  own.output_extent = {1, 1};
  own.depth = true;
  own.velocity = own.checkerboard = false;
  return open_feed(Feed::Kind::kParticles, own);
}

// The region has what its own plans read.
Status FrameSource::open_focus_feed(const gl::BridgeSettings& bridging,
                                    const std::vector<ResolvePlan>& plans) {
  if (!focus_) return {};
  gl::BridgeSettings own = bridging;
  own.target_extent = focus_->settings().target_extent;
  own.output_extent = focus_->settings().extent;
  own.checkerboard = own.depth = own.velocity = own.reactive = false;
  for (const ResolvePlan& plan : plans) {
    const std::optional<ResolvePlan> region = plan.focus_plan();
    if (!region) continue;
    own.depth |= region->reads_depth;
    own.velocity |= region->velocity == VelocitySource::kTarget;
    own.reactive |= region->reads_reactive;
  }
  return open_feed(Feed::Kind::kFocus, own);
}

Extent FrameSource::Feed::viewport(const DrawnFrame& frame) const {
  switch (kind) {
    case Kind::kPicture:
      return frame.view.render;
    case Kind::kParticles:
      return frame.view.particles;
    case Kind::kFocus:
      return frame.region->view.render;
  }
  return {};
}

const gl::RenderTargets* FrameSource::targets_of(Feed::Kind kind) const {
  const auto found =
      std::find_if(feeds_.begin(), feeds_.end(), [kind](const Feed& feed) { return feed.kind == kind; });
  return found == feeds_.end() ? nullptr : found->targets;
}

gl::Bridge::Memory FrameSource::memory() const {
  gl::Bridge::Memory memory;
  for (const Feed& feed : feeds_) {
    memory.gl_bytes += feed.bridge->memory().gl_bytes;
    memory.opencl_bytes += feed.bridge->memory().opencl_bytes;
  }
  return memory;
}

std::string crossing_text(const gl::Bridge& bridge) {
  const gl::Bridge::Traffic& traffic = bridge.traffic();
  return fmt::format("{}: {:.2f} ms and {:.1f} MB there, {:.2f} ms and {:.1f} MB back",
                     gl::name_of(bridge.kind()), traffic.acquire_ms,
                     1e-6 * static_cast<double>(traffic.bytes_in), traffic.present_ms,
                     1e-6 * static_cast<double>(traffic.bytes_out));
}

std::uint64_t FrameSource::bytes_in() const {
  std::uint64_t bytes = 0;
  for (const Feed& feed : feeds_) {
    if (feed.kind != Feed::Kind::kFocus || focus_inputs_) bytes += feed.bridge->traffic().bytes_in;
  }
  return bytes;
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

Status FrameSource::begin(std::int64_t index, const FrameView& view, bool keep) {
  const bool cut = is_cut(scene(), view.previous_seconds, view.seconds);
  const Extent output = outputs_ ? outputs_->next(view.render) : sequence_->output();
  DrawnFrame frame = {.index = index, .output = output, .view = view, .reset = cut || index == 0};
  if (cut) frame.view.previous_seconds = view.seconds;
  frame.view.display = display_;
  parts_->choose(frame.view);
  if (focus_) frame.region = focus_->at(index, frame.view, frame.reset);
  for (Feed& feed : feeds_) {
    feed.targets = nullptr;
    if (!feed.is_in(frame)) continue;
    auto targets = feed.bridge->begin_draw(feed.slot(frame), feed.viewport(frame));
    if (!targets.ok()) return targets.status();
    feed.targets = targets.value();
  }
  const FrameParts parts = parts_->parts(index, targets_of(Feed::Kind::kParticles));
  if (Status status = renderer().draw(*feeds_.front().targets, frame.view, parts); !status.ok())
    return status;
  parts_->learn();
  if (frame.region) {
    const Status status = renderer().draw(*targets_of(Feed::Kind::kFocus), frame.region->view);
    if (!status.ok()) return status;
  }
  if (keep) {
    if (Status status = keep_targets(frame); !status.ok()) return status;
  }
  drawn_.push_back(std::move(frame));
  return {};
}

Result<gl::TargetPixels> FrameSource::draw_relative_to(double seconds) {
  const DrawnFrame& frame = drawn_.back();
  Feed& feed = feeds_.front();
  FrameView view = frame.view;
  view.previous_seconds = seconds;
  view.particles = {};  // with everything else: they write no velocity
  auto targets = feed.bridge->begin_draw(feed.slot(frame), view.render);
  if (!targets.ok()) return targets.status();
  if (Status status = renderer().draw(*targets.value(), view); !status.ok()) return status;
  auto pixels = gl::read_targets(*targets.value(), view.render);
  if (Status status = feed.bridge->submit(feed.slot(frame)); !status.ok()) return status;
  return pixels;
}

Status FrameSource::keep_targets(DrawnFrame& frame) const {
  for (const Feed& feed : feeds_) {
    if (feed.targets == nullptr) continue;
    gl::TargetPixels& kept = feed.kind == Feed::Kind::kPicture     ? frame.targets
                             : feed.kind == Feed::Kind::kParticles ? frame.particles
                                                                   : frame.focus;
    auto read = gl::read_targets(*feed.targets, feed.viewport(frame));
    if (!read.ok()) return read.status();
    kept = std::move(read).value();
  }
  if (frame.view.parity) blank_unshaded(frame.targets, *frame.view.parity);
  return {};
}

Status FrameSource::submit() {
  for (Feed& feed : feeds_) {
    if (feed.targets == nullptr) continue;
    if (Status status = feed.bridge->submit(feed.slot(drawn_.back())); !status.ok()) return status;
  }
  return {};
}

Result<FrameInputs> FrameSource::acquire() {
  const DrawnFrame& frame = drawn_.front();
  focus_inputs_.reset();
  FrameInputs inputs;
  inputs.render_extent = frame.view.render;
  inputs.output_extent = frame.output;
  inputs.jitter = frame.view.jitter;
  inputs.parity = frame.view.parity.value_or(0);
  inputs.camera = stage_->renderer->camera_motion(frame.view);
  inputs.exposure = exposure();
  inputs.frame_index = static_cast<std::uint64_t>(frame.index);
  inputs.reset = frame.reset;
  for (Feed& feed : feeds_) {
    if (!feed.is_in(frame)) continue;
    const auto shared = feed.bridge->acquire(feed.slot(frame));
    if (!shared.ok()) return shared.status();
    bind(feed.kind, shared.value(), inputs);
  }
  return inputs;
}

// Gives the images of the oldest frame to where its inputs have them.
void FrameSource::bind(Feed::Kind kind, const gl::SharedFrame& shared, FrameInputs& inputs) {
  const DrawnFrame& frame = drawn_.front();
  if (kind == Feed::Kind::kParticles) {
    inputs.particle_colour = shared.colour;
    inputs.particle_depth = shared.depth;
    inputs.particle_reactive = shared.reactive;
    inputs.particle_render_extent = frame.view.particles;
    return;
  }
  const bool focused = kind == Feed::Kind::kFocus;
  FrameInputs& whole = focused ? focus_inputs_.emplace().frame : inputs;
  whole.colour = shared.colour;
  whole.depth = shared.depth;
  whole.velocity = shared.velocity;
  whole.reactive = shared.reactive;
  if (!focused) return;
  whole.render_extent = frame.region->view.render;
  whole.jitter = frame.region->view.jitter;
  whole.camera = stage_->renderer->camera_motion(frame.region->view);
  whole.reset = frame.region->reset;
  focus_inputs_->x = frame.region->place.region.x;
  focus_inputs_->y = frame.region->place.region.y;
  focus_inputs_->rectangles[0] = frame.region->place.shown;
  focus_inputs_->rectangle_count = 1;
}

}  // namespace quincunx::scenes
