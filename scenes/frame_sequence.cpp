// SPDX-License-Identifier: MIT
#include "frame_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace quincunx::scenes {
namespace {

constexpr Extent kFloor = {8, 8};
constexpr int kStep = 2;

// Halton's radical inverse of `index` in `base`, in (0, 1) for index >= 1.
double radical_inverse(std::int64_t index, int base) {
  double result = 0;
  double digit_weight = 1.0 / base;
  for (; index > 0; index /= base, digit_weight /= base) {
    result += static_cast<double>(index % base) * digit_weight;
  }
  return result;
}

Vec2 halton(std::int64_t index, Vec2 ratio) {
  const double scale = static_cast<double>(ratio.x) * ratio.y;
  const auto phases = static_cast<std::int64_t>(std::ceil(8 / std::max(scale, 1.0 / 64)));
  double mean_x = 0;
  double mean_y = 0;
  for (std::int64_t i = 1; i <= phases; ++i) {
    mean_x += radical_inverse(i, 2) / static_cast<double>(phases);
    mean_y += radical_inverse(i, 3) / static_cast<double>(phases);
  }
  const std::int64_t phase = index % phases + 1;
  return {static_cast<float>(radical_inverse(phase, 2) - mean_x),
          static_cast<float>(radical_inverse(phase, 3) - mean_y)};
}

}  // namespace

const char* name_of(Jitter jitter) {
  switch (jitter) {
    case Jitter::kNone:
      return "none";
    case Jitter::kQuincunx:
      return "quincunx";
    case Jitter::kQuincunxHalf:
      return "quincunx-half";
    case Jitter::kHalton:
      return "halton";
  }
  return "unknown";
}

Vec2 jitter_of(Jitter jitter, std::int64_t index, Vec2 ratio) {
  switch (jitter) {
    case Jitter::kNone:
      return {};
    case Jitter::kQuincunx:
      return index % 2 == 0 ? Vec2{-0.25f, -0.25f} : Vec2{0.25f, 0.25f};
    case Jitter::kQuincunxHalf:
      return index % 2 == 0 ? Vec2{} : Vec2{0.5f, 0.5f};
    case Jitter::kHalton:
      return halton(index, ratio);
  }
  return {};
}

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
