// SPDX-License-Identifier: MIT
#include "frame_source.h"

#include "scene_catalog.h"

namespace quincunx::scenes {

Result<std::unique_ptr<FrameSource>> FrameSource::create(const FrameSourceSettings& settings) {
  auto source = std::unique_ptr<FrameSource>(new FrameSource(settings));
  if (Status status = source->open(); !status.ok()) return status;
  return source;
}

Status FrameSource::open() {
  auto sequence = FrameSequence::create(settings_.sequence);
  if (!sequence.ok()) return sequence.status();
  sequence_ = sequence.value();
  auto scene = open_scene(settings_.scene, settings_.seed);
  if (!scene.ok()) return scene.status();
  scene_ = std::move(scene).value();

  Device::list();  // some drivers want OpenCL enumerated before a GL context exists
  auto context = gl::EglContext::create(settings_.platform);
  if (!context.ok()) return context.status();
  context_ = std::move(context).value();
  auto device = gl::open_device(*context_, settings_.device, settings_.interop);
  if (!device.ok()) return device.status();
  device_ = device.value();
  auto renderer = Renderer::create(scene_);
  if (!renderer.ok()) return renderer.status();
  renderer_ = std::move(renderer).value();
  return {};
}

Result<ResolvePlan> FrameSource::connect(ResolveSettings resolve, HandOver hand_over) {
  resolve.output = sequence_->output();
  resolve.target = sequence_->target();
  const auto plan = plan_for(needs_of(scene_), resolve);
  if (!plan.ok()) return plan.status();

  gl::BridgeSettings bridging;
  bridging.interop = settings_.interop;
  bridging.target = resolve.target;
  bridging.output = resolve.output;
  const bool every = hand_over == HandOver::kEvery;
  bridging.depth = every || plan->reads_depth;
  bridging.velocity = every || plan->velocity == VelocitySource::kTarget;
  bridging.reactive = every || plan->reads_reactive;
  auto bridge = gl::Bridge::create(*context_, *device_, bridging);
  if (!bridge.ok()) return bridge.status();
  bridge_ = std::move(bridge).value();

  resolve.storage = bridge_->storage();
  return plan_for(needs_of(scene_), resolve);
}

Status FrameSource::draw(std::int64_t index, bool keep_targets) {
  DrawnFrame frame = {.index = index, .view = sequence_->at(index)};
  const int slot = static_cast<int>(index % bridge_->slots());
  auto targets = bridge_->begin_draw(slot);
  if (!targets.ok()) return targets.status();
  if (Status status = renderer_->draw(*targets.value(), frame.view); !status.ok()) return status;
  if (keep_targets) frame.targets = gl::read_targets(*targets.value(), frame.view.render);
  if (Status status = bridge_->submit(slot, frame.view.render); !status.ok()) return status;
  drawn_.push_back(std::move(frame));
  return {};
}

Result<FrameInputs> FrameSource::acquire() {
  const DrawnFrame& frame = drawn_.front();
  auto shared = bridge_->acquire(static_cast<int>(frame.index % bridge_->slots()));
  if (!shared.ok()) return shared.status();
  FrameInputs inputs;
  inputs.colour = shared->colour;
  inputs.depth = shared->depth;
  inputs.velocity = shared->velocity;
  inputs.reactive = shared->reactive;
  inputs.render = frame.view.render;
  inputs.jitter = frame.view.jitter;
  inputs.camera = renderer_->camera_motion(frame.view);
  inputs.exposure = settings_.exposure > 0 ? settings_.exposure : scene_.exposure;
  inputs.frame_index = static_cast<std::uint64_t>(frame.index);
  return inputs;
}

}  // namespace quincunx::scenes
