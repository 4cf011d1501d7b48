// SPDX-License-Identifier: MIT
#include "quincunx/control/error_front.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <tuple>

#include "quincunx/advanced/content_statistics.h"
#include "ranges.h"

namespace quincunx {
namespace {

// Returns a field of one class and method at a scale: linear between the points, which ascend in scale, and that of the
// nearest beyond them. Nothing where there is no point, or where the scale is not above 0.
std::optional<double> value_at(std::span<const FrontPoint> curve, double scale, double FrontPoint::*field) {
  if (curve.empty() || !(scale > 0)) return std::nullopt;
  if (scale <= curve.front().scale) return curve.front().*field;
  if (scale >= curve.back().scale) return curve.back().*field;
  const auto above = std::upper_bound(curve.begin(), curve.end(), scale,
                                      [](double at, const FrontPoint& point) { return at < point.scale; });
  const FrontPoint& low = *(above - 1);
  return std::lerp(low.*field, (*above).*field, (scale - low.scale) / (above->scale - low.scale));
}

auto place_of(const FrontPoint& point) {
  return std::tuple(point.scene_class, point.method, point.scale);
}

std::string text_of(const FrontPoint& point) {
  return fmt::format("{} of {} at scale {}", name_of(point.method), name_of(point.scene_class), point.scale);
}

Status check(const FrontPoint& point) {
  constexpr double kMaxMs = 60000;
  Ranges ranges;
  ranges.lies_in("the scale", point.scale, 0, 1, Ends::kOpenLow);
  ranges.lies_in("flip", point.flip, 0, 1);
  ranges.lies_in("flip_spread", point.flip_spread, 0, 1);
  ranges.lies_in("psnr_db", point.psnr_db, 0, FrontPoint::kMaxPsnr);
  ranges.lies_in("psnr_spread", point.psnr_spread, 0, FrontPoint::kMaxPsnr);
  ranges.lies_in("ms_per_megapixel", point.ms_per_megapixel, 0, kMaxMs, Ends::kOpenLow);
  ranges.lies_in("ms_spread", point.ms_spread, 0, kMaxMs);
  return ranges.status().ok() ? Status() : Status::invalid(text_of(point) + ": " + ranges.status().message());
}

bool dominates(const FrontPoint& a, const FrontPoint& b) {
  const bool no_worse = a.scale <= b.scale && a.ms_per_megapixel <= b.ms_per_megapixel && a.flip <= b.flip;
  return no_worse && (a.scale < b.scale || a.ms_per_megapixel < b.ms_per_megapixel || a.flip < b.flip);
}

}  // namespace

const char* name_of(SceneClass scene_class) {
  constexpr const char* kNames[kSceneClasses] = {"still", "pan", "objects", "thin", "light", "zoom"};
  const auto place = static_cast<std::size_t>(scene_class);
  return place < kSceneClasses ? kNames[place] : "unknown";
}

bool SceneMix::valid() const {
  constexpr double kRounding = 1e-6;
  double sum = 0;
  for (const double part : share) {
    if (!(part >= 0)) return false;
    sum += part;
  }
  return std::abs(sum - 1) <= kRounding;
}

Result<ErrorFront> ErrorFront::create(FrontSource source, std::vector<FrontPoint> points) {
  for (const FrontPoint& point : points) {
    if (Status status = check(point); !status.ok()) return status;
  }
  std::sort(points.begin(), points.end(),
            [](const FrontPoint& a, const FrontPoint& b) { return place_of(a) < place_of(b); });
  const auto twice =
      std::adjacent_find(points.begin(), points.end(),
                         [](const FrontPoint& a, const FrontPoint& b) { return place_of(a) == place_of(b); });
  if (twice != points.end()) return Status::invalid(text_of(*twice) + " is there twice");
  ErrorFront front(std::move(source), std::move(points));
  if (front.methods_.empty()) return Status::invalid("there is no point; there must be one at least");
  for (std::size_t i = 0; i < kSceneClasses; ++i) {
    for (const MethodVariant& method : front.methods_) {
      const auto scene_class = static_cast<SceneClass>(i);
      if (!front.curve(scene_class, method).empty()) continue;
      return Status::invalid(fmt::format("{} has no point of {}; each method needs one in every class",
                                         name_of(method), name_of(scene_class)));
    }
  }
  return front;
}

ErrorFront::ErrorFront(FrontSource source, std::vector<FrontPoint> points)
    : source_(std::move(source)), points_(std::move(points)) {
  for (const FrontPoint& point : points_) {
    if (std::find(methods_.begin(), methods_.end(), point.method) == methods_.end())
      methods_.push_back(point.method);
  }
  std::sort(methods_.begin(), methods_.end());
}

std::span<const FrontPoint> ErrorFront::curve(SceneClass scene_class, const MethodVariant& method) const {
  const auto wanted = std::tuple(scene_class, method);
  const auto curve_of = [](const FrontPoint& p) { return std::tuple(p.scene_class, p.method); };
  const auto first = std::partition_point(points_.begin(), points_.end(),
                                          [&](const FrontPoint& p) { return curve_of(p) < wanted; });
  const auto last =
      std::partition_point(first, points_.end(), [&](const FrontPoint& p) { return curve_of(p) == wanted; });
  return {first, last};
}

std::vector<FrontPoint> ErrorFront::front(SceneClass scene_class) const {
  std::vector<FrontPoint> front;
  for (const FrontPoint& point : points_) {
    const bool dominated = std::any_of(points_.begin(), points_.end(), [&](const FrontPoint& other) {
      return other.scene_class == scene_class && dominates(other, point);
    });
    if (point.scene_class == scene_class && !dominated) front.push_back(point);
  }
  return front;
}

std::optional<double> ErrorFront::flip(const SceneMix& mix, const MethodVariant& method, double scale) const {
  if (!mix.valid()) return std::nullopt;
  double sum = 0;
  for (std::size_t i = 0; i < kSceneClasses; ++i) {
    const auto flip = value_at(curve(static_cast<SceneClass>(i), method), scale, &FrontPoint::flip);
    if (!flip) return std::nullopt;
    sum += mix.share[i] * *flip;
  }
  return sum;
}

std::optional<double> ErrorFront::resolve_ms(const MethodVariant& method, double scale,
                                             double output_megapixels) const {
  if (!(output_megapixels > 0 && output_megapixels <= kMaxMegapixels)) return std::nullopt;
  double sum = 0;
  for (std::size_t i = 0; i < kSceneClasses; ++i) {
    const auto ms = value_at(curve(static_cast<SceneClass>(i), method), scale, &FrontPoint::ms_per_megapixel);
    if (!ms) return std::nullopt;
    sum += *ms;
  }
  return sum / kSceneClasses * output_megapixels;
}

Status check(const ContentStatistics& content) {
  Ranges ranges;
  ranges.lies_in("content.moving", content.moving, 0, 1);
  ranges.lies_in("content.apart", content.apart, 0, 1);
  ranges.lies_in("content.thin", content.thin, 0, 1);
  ranges.lies_in("content.light", content.light, 0, 1);
  ranges.lies_in("content.zoom", content.zoom, 0, 1);
  ranges.at_least("content.speed_px", content.speed_px, 0);
  return ranges.status();
}

SceneMix mix_of(const ContentStatistics& content) {
  SceneMix mix;
  double left = 1;
  const auto take = [&](SceneClass scene_class, double share) {
    const double taken = std::min(left, share);
    mix.share[static_cast<std::size_t>(scene_class)] = taken;
    left -= taken;
    return taken;
  };
  take(SceneClass::kLight, content.light);
  double moving = content.moving;
  moving -= take(SceneClass::kThin, content.thin);
  moving -= take(SceneClass::kObjects, std::max(0.0, content.apart - content.thin));
  moving -= take(SceneClass::kZoom, std::clamp(moving, 0.0, content.zoom));
  take(SceneClass::kPan, std::max(0.0, moving));
  take(SceneClass::kStill, left);
  return mix;
}

}  // namespace quincunx
