// SPDX-License-Identifier: MIT
#include "frames/frame_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "random.h"
#include "tools/program/command_line.h"

namespace quincunx::scenes {
namespace {

constexpr float kSmallest = 0.01f;
constexpr float kLargest = 2.0f;

bool usable(float scale) {
  return scale >= kSmallest && scale <= kLargest;
}

float mix(float a, float b, double t) {
  return static_cast<float>(a + (b - a) * t);
}

// "A,B,C" as numbers; empty when any part is not one.
std::vector<float> numbers(std::string_view text) {
  std::vector<float> values;
  for (;;) {
    const std::size_t comma = std::min(text.find(','), text.size());
    float value = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + comma, value);
    if (parsed.ec != std::errc() || parsed.ptr != text.data() + comma) return {};
    values.push_back(value);
    if (comma == text.size()) return values;
    text.remove_prefix(comma + 1);
  }
}

constexpr double kLeastScale = 0.1;
constexpr double kLeastRandomScale = 0.5;

Extent scaled(Extent display, double scale) {
  const auto side = [scale](int pixels) {
    return std::max(1, static_cast<int>(std::lround(pixels * scale)));
  };
  return {side(display.width), side(display.height)};
}

constexpr Extent kFloor = {8, 8};
constexpr int kStep = 2;

// Both frames of a pair, which shade all pixels between them, have the same place of a long jitter: were its base 2 in
// step with the parity, each half of the pixels would get only half of the places.
std::int64_t jitter_index(const SequenceSettings& settings, std::int64_t index) {
  const bool pairs = settings.shading == Shading::kCheckerboard && settings.jitter == Jitter::kHalton;
  return pairs ? index / 2 : index;
}

}  // namespace

Result<ScalePath> ScalePath::fixed(Vec2 scale) {
  if (!usable(scale.x) || !usable(scale.y)) {
    return Status::invalid(
        fmt::format("scale is {} x {}; both must lie in [{}, {}]", scale.x, scale.y, kSmallest, kLargest));
  }
  ScalePath path;
  path.a_ = scale.x;
  path.b_ = scale.y;
  return path;
}

Result<ScalePath> ScalePath::parse(const std::string& text, std::uint64_t seed) {
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  ScalePath path;
  path.seed_ = seed;
  std::vector<float> scales;
  if (name == "sweep") {
    path.kind_ = Kind::kSweep;
    scales = {0.5f, 1.0f, 0.71f};
  } else if (name == "ramp") {
    path.kind_ = Kind::kRamp;
    scales = {0.5f, 1.0f};
  } else if (name == "random") {
    path.kind_ = Kind::kRandom;
    scales = {0.5f, 1.0f};
  } else {
    return Status::invalid(
        fmt::format("scale path '{}' is not known; there are sweep[:A,B,C], ramp[:A,B] and random[:A,B]{}",
                    text, tools::did_you_mean(name, {"sweep", "ramp", "random"})));
  }
  const std::size_t wanted = scales.size();
  if (colon != std::string::npos) scales = numbers(std::string_view(text).substr(colon + 1));
  if (scales.size() != wanted || !std::all_of(scales.begin(), scales.end(), usable)) {
    return Status::invalid(
        fmt::format("scale path '{}' must be {} followed by nothing or by ':' and {} scales in "
                    "[{}, {}] with commas between them",
                    text, name, wanted, kSmallest, kLargest));
  }
  path.a_ = scales[0];
  path.b_ = scales[1];
  path.c_ = scales.back();
  return path;
}

Vec2 ScalePath::at(std::int64_t index, std::int64_t count) const {
  const double t = count > 1 ? static_cast<double>(index) / static_cast<double>(count - 1) : 0.0;
  switch (kind_) {
    case Kind::kFixed:
      return {a_, b_};
    case Kind::kRamp:
      return {mix(a_, b_, t), mix(a_, b_, t)};
    case Kind::kSweep: {
      const float scale = t < 0.5 ? mix(a_, b_, 2 * t) : mix(b_, c_, 2 * t - 1);
      return {scale, scale};
    }
    case Kind::kRandom: {
      Random random(seed_, static_cast<std::uint64_t>(index));
      const float x = random.range(a_, b_);
      return {x, random.range(a_, b_)};
    }
  }
  return {1, 1};
}

float ScalePath::largest() const {
  return kind_ == Kind::kSweep ? std::max({a_, b_, c_}) : std::max(a_, b_);
}

Result<OutputPath> OutputPath::parse(const std::string& text, Extent display, std::uint64_t seed) {
  OutputPath path(display, seed);
  if (text == "random") return path;
  if (text == "auto") {
    auto follower = OutputFollower::create({.display = display});
    if (!follower.ok()) return follower.status();
    path.follower_ = follower.value();
    return path;
  }
  double scale = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, scale);
  if (read.ec != std::errc() || read.ptr != end || !(scale >= kLeastScale && scale <= 1)) {
    return Status::invalid(
        fmt::format("--dual '{}' is no resolution of the output; write auto, random, or a scale from {} to 1",
                    text, kLeastScale));
  }
  path.fixed_ = scaled(display, scale);
  return path;
}

Extent OutputPath::next(Extent render) {
  if (fixed_) return *fixed_;
  if (follower_) return follower_->observe(render);
  const auto side = [this](int least, int most) {
    return least + static_cast<int>(random_() % static_cast<std::uint64_t>(most - least + 1));
  };
  const int width = side(min_output().width, display_.width);
  return {width, side(min_output().height, display_.height)};
}

Extent OutputPath::min_output() const {
  if (fixed_) return *fixed_;
  return follower_ ? follower_->min_output() : scaled(display_, kLeastRandomScale);
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
  return at(index, viewport_.render());
}

FrameView FrameSequence::at(std::int64_t index, Extent render) {
  static_cast<void>(viewport_.set_render(render));  // one that does not fit leaves the last one
  FrameView view;
  view.render = viewport_.render();
  const std::int64_t at = settings_.backwards ? settings_.frames - 1 - index : index;
  const std::int64_t before = settings_.backwards ? at + 1 : at - 1;
  view.jitter = jitter_of(settings_.jitter, jitter_index(settings_, at), view.render, settings_.output);
  if (settings_.shading == Shading::kCheckerboard) view.parity = static_cast<int>(index & 1);
  view.seconds = settings_.start_seconds + static_cast<double>(at) / settings_.fps;
  view.previous_seconds = settings_.start_seconds + static_cast<double>(before) / settings_.fps;
  view.aspect = static_cast<float>(settings_.output.width) / static_cast<float>(settings_.output.height);
  view.lod_bias = settings_.detail.lod_bias +
                  settings_.detail.follows_scale * texture_lod_bias(view.render, settings_.output);
  return view;
}

}  // namespace quincunx::scenes
