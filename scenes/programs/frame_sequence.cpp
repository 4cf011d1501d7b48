// SPDX-License-Identifier: MIT
#include "programs/frame_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace quincunx::scenes {
namespace {

constexpr Extent kFloor = {8, 8};
constexpr int kStep = 2;

// Both frames of a pair, which shade all pixels between them, have the same place of a long jitter: were its base 2 in
// step with the parity, each half of the pixels would get only half of the places.
std::int64_t jitter_index(const SequenceSettings& settings, std::int64_t index) {
  const bool pairs = settings.shading == Shading::kCheckerboard && settings.jitter == Jitter::kHalton;
  return pairs ? index / 2 : index;
}

float lod_bias_of(const TextureDetail& detail, Vec2 scale) {
  return detail.lod_bias + detail.follows_scale * 0.5f * std::log2(scale.x * scale.y);
}

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
  view.jitter = jitter_of(settings_.jitter, jitter_index(settings_, index), viewport_.ratio());
  if (settings_.shading == Shading::kCheckerboard) view.parity = static_cast<int>(index & 1);
  view.seconds = settings_.start_seconds + static_cast<double>(index) / settings_.fps;
  view.previous_seconds = settings_.start_seconds + static_cast<double>(index - 1) / settings_.fps;
  view.aspect = static_cast<float>(settings_.output.width) / static_cast<float>(settings_.output.height);
  view.lod_bias = lod_bias_of(settings_.detail, viewport_.ratio());
  return view;
}

}  // namespace quincunx::scenes
