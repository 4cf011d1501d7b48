// SPDX-License-Identifier: MIT
#include "programs/focus_feed.h"

#include <cmath>

namespace quincunx::scenes {

Result<std::unique_ptr<FocusFeed>> FocusFeed::create(const FocusOptions& options, const Scene& scene,
                                                     const SequenceSettings& picture) {
  FocusTimes times = {picture.start_seconds, 1 / picture.fps, picture.frames};
  if (options.endless) times.count = static_cast<std::int64_t>(std::ceil(scene.duration * picture.fps));
  auto path = FocusPath::create(*options.target, scene, picture.output, times);
  if (!path.ok()) return path.status();
  if (path->region().area() == 0) return std::unique_ptr<FocusFeed>();
  SequenceSettings region = picture;
  region.output = path->region();
  region.shading = Shading::kFull;
  auto scale = ScalePath::fixed({options.scale, options.scale});
  if (!scale.ok()) return scale.status();
  region.scale_path = scale.value();
  auto sequence = FrameSequence::create(region);
  if (!sequence.ok()) return sequence.status();
  return std::unique_ptr<FocusFeed>(new FocusFeed(path.value(), sequence.value(), picture.output));
}

Status FocusFeed::connect(const gl::EglContext& context, const Device& device, gl::BridgeSettings picture,
                          const std::vector<ResolvePlan>& plans) {
  picture.target = sequence_.target();
  picture.output = sequence_.output();
  picture.checkerboard = picture.depth = picture.velocity = picture.reactive = false;
  for (const ResolvePlan& plan : plans) {
    const std::optional<ResolvePlan> region = plan.focus_plan();
    if (!region) continue;
    picture.depth |= region->reads_depth;
    picture.velocity |= region->velocity == VelocitySource::kTarget;
    picture.reactive |= region->reads_reactive;
  }
  auto bridge = gl::Bridge::create(context, device, picture);
  if (!bridge.ok()) return bridge.status();
  bridge_ = std::move(bridge).value();
  return {};
}

ViewWindow FocusFeed::window_of(const Rectangle& region) const {
  const glm::dvec2 picture(output_.width, output_.height);
  return {glm::dvec2(region.x, region.y) / picture, glm::dvec2(region.width, region.height) / picture};
}

Status FocusFeed::begin(Renderer& renderer, std::int64_t index, const FrameView& view, bool reset,
                        gl::TargetPixels* pixels) {
  const std::optional<FocusPlace> place = path_.at(view.seconds, pointer_);
  if (!place) {
    previous_.reset();
    drawn_.emplace_back(std::nullopt);
    return {};
  }
  const bool follows = previous_.has_value() && !reset;
  const Rectangle previous = follows ? *previous_ : place->region;
  previous_ = place->region;
  Drawn frame = {
      .slot = static_cast<int>(index % bridge_->slots()), .view = view, .place = *place, .reset = !follows};
  const FrameView own = sequence_.at(index);
  frame.view.render = own.render;
  frame.view.jitter = own.jitter;
  frame.view.lod_bias = own.lod_bias;
  frame.view.parity = {};
  frame.view.least_size = 0;
  frame.view.particles = {};  // with everything else
  frame.view.window = window_of(place->region);
  frame.view.previous_window = window_of(previous);
  auto targets = bridge_->begin_draw(frame.slot, frame.view.render);
  if (!targets.ok()) return targets.status();
  if (Status status = renderer.draw(*targets.value(), frame.view); !status.ok()) return status;
  if (pixels != nullptr) *pixels = gl::read_targets(*targets.value(), frame.view.render);
  drawn_.emplace_back(frame);
  return {};
}

Status FocusFeed::submit() {
  return drawn_.back() ? bridge_->submit(drawn_.back()->slot) : Status();
}

Status FocusFeed::acquire(const Renderer& renderer) {
  inputs_.reset();
  if (!drawn_.front()) return {};
  const Drawn& frame = *drawn_.front();
  auto shared = bridge_->acquire(frame.slot);
  if (!shared.ok()) return shared.status();
  FocusInputs& focus = inputs_.emplace();
  focus.frame.colour = shared->colour;
  focus.frame.depth = shared->depth;
  focus.frame.velocity = shared->velocity;
  focus.frame.reactive = shared->reactive;
  focus.frame.render = frame.view.render;
  focus.frame.jitter = frame.view.jitter;
  focus.frame.camera = renderer.camera_motion(frame.view);
  focus.frame.reset = frame.reset;
  focus.x = frame.place.region.x;
  focus.y = frame.place.region.y;
  focus.rectangles[0] = frame.place.shown;
  focus.rectangle_count = 1;
  return {};
}

}  // namespace quincunx::scenes
