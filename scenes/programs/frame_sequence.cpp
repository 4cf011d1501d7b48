// SPDX-License-Identifier: MIT
#include "programs/frame_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace quincunx::scenes {
namespace {

constexpr Extent kFloor = {8, 8};
constexpr int kStep = 2;

}  // namespace

Result<FrameSequence> FrameSequence::create(const SequenceSettings& settings) {
  if (settings.frames < 1) {
    return Status::invalid(fmt::format("frames is {}; there must be at least 1", settings.frames));
  }
  if (!(settings.fps > 0 && std::isfinite(settings.fps))) {
    return Status::invalid(fmt::format("fps is {}; it must be a positive finite number", settings.fps));
  }
  if (!std::isfinite(settings.start_seconds)) {
    return Status::invalid(
        fmt::format("start is {}; it must be a finite number of seconds", settings.start_seconds));
  }
  const float max_scale = std::max(1.0f, settings.scale_path.largest());
  auto viewport = DynamicViewport::create(settings.output, max_scale, kStep, kFloor);
  if (!viewport.ok()) return viewport.status();
  return FrameSequence(settings, viewport.value());
}

FrameView FrameSequence::at(std::int64_t index) {
  const Vec2 scale = settings_.scale_path.at(index, settings_.frames);
  // A ScalePath gives positive finite scales only, so this cannot fail.
  static_cast<void>(viewport_.set_scale(scale.x, scale.y));
  return at(index, viewport_.render());
}

FrameView FrameSequence::at(std::int64_t index, Extent render) {
  static_cast<void>(viewport_.set_render(render));  // one that does not fit leaves the last one
  FrameView view;
  view.render = viewport_.render();
  view.jitter = jitter_of(settings_.jitter, index, viewport_.ratio());
  view.seconds = settings_.start_seconds + static_cast<double>(index) / settings_.fps;
  view.previous_seconds = settings_.start_seconds + static_cast<double>(index - 1) / settings_.fps;
  view.aspect = static_cast<float>(settings_.output.width) / static_cast<float>(settings_.output.height);
  view.lod_bias = settings_.lod_bias;
  return view;
}

}  // namespace quincunx::scenes
