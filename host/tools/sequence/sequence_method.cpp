// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_method.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace quincunx::tools {
namespace {

constexpr float kSamePlace = .01f;
constexpr std::size_t kFewPlaces = 3;

// How far a distance is from half a pixel, or one and a half.
float from_half(float distance) {
  return std::abs(distance - std::floor(distance) - .5f);
}

}  // namespace

JitterKind kind_of(std::span<const Vec2> jitters) {
  std::vector<Vec2> places;
  for (const Vec2 jitter : jitters) {
    const bool known = std::any_of(places.begin(), places.end(), [&](Vec2 place) {
      return std::abs(place.x - jitter.x) <= kSamePlace && std::abs(place.y - jitter.y) <= kSamePlace;
    });
    if (!known) places.push_back(jitter);
  }
  if (jitters.size() == 1) return jitters[0] == Vec2{} ? JitterKind::kNone : JitterKind::kFew;
  if (places.size() <= 1) return JitterKind::kNone;
  return places.size() <= kFewPlaces ? JitterKind::kFew : JitterKind::kMany;
}

bool alternates(std::span<const Vec2> jitters) {
  constexpr float kTolerance = .15f;
  std::size_t good = 0;
  for (std::size_t i = 1; i < jitters.size(); ++i) {
    const bool apart = from_half(jitters[i].x - jitters[i - 1].x) <= kTolerance &&
                       from_half(jitters[i].y - jitters[i - 1].y) <= kTolerance;
    good += apart ? 1 : 0;
  }
  return jitters.size() > 1 && 2 * good > jitters.size() - 1;
}

std::vector<Vec2> jitters_about(const FramePattern& pattern, const SequenceFormat& format,
                                std::int64_t number) {
  constexpr std::int64_t kReach = 6;
  std::vector<Vec2> jitters;
  for (std::int64_t n = std::max<std::int64_t>(number - kReach, 0); n <= number + kReach; ++n) {
    const std::string path = pattern.expand(n);
    const auto reader = ImageReader::open(path);
    if (!reader.ok()) continue;
    const auto attributes = frame_attributes(path, reader->header());
    if (!attributes.ok()) continue;
    const Extent render = reader->header().parts.front().display.extent;
    const auto jitter = format.jitter.at(path, n, attributes.value(), format.ratio_of(render));
    if (jitter.ok()) jitters.push_back(jitter.value());
  }
  return jitters;
}

MethodDefault default_method(const SequenceFormat& format, JitterKind jitter,
                             const ResolveSettings& settings) {
  const bool moves = format.motion != MotionSource::kNone;
  if (!moves) return {"catmull-rom", "no motion is known, so frames stay apart"};
  const bool needs_depth = format.motion == MotionSource::kCamera || settings.far != FarMotion::kAsDrawn ||
                           settings.drawn_velocity == DrawnVelocity::kDilated;
  if (format.channels.has_depth() || needs_depth) {
    if (jitter == JitterKind::kNone)
      return {"quincunx:reprojected", "motion and depth are known, but no jitter"};
    return {"temporal", "motion, depth and a jitter are known"};
  }
  if (jitter == JitterKind::kNone) return {"catmull-rom", "neither depth nor a jitter is known"};
  return {"quincunx", "motion and a jitter are known, but no depth"};
}

}  // namespace quincunx::tools
