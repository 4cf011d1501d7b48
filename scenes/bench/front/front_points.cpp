// SPDX-License-Identifier: MIT
#include "bench/front/front_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "bench/speed_error/bench_statistics.h"

namespace quincunx::bench {
namespace {

using Names = std::string_view[];

constexpr Names kStill = {"still"};
constexpr Names kPan = {"pan"};
constexpr Names kObjects = {"occluders", "wheel"};
constexpr Names kThin = {"wires"};
constexpr Names kLight = {"shadows", "sparkles"};
constexpr Names kZoom = {"zoom"};

constexpr Names kHeldStill = {"chart"};
constexpr Names kHeldPan = {"backdrop", "cut"};
constexpr Names kHeldObjects = {"courtyard", "cutout"};
constexpr Names kHeldThin = {"cables", "fence"};
constexpr Names kHeldLight = {"particles"};
constexpr Names kHeldZoom = {"flight"};

constexpr ClassScenes kClasses[] = {
    {SceneClass::kStill, kStill, kHeldStill},       {SceneClass::kPan, kPan, kHeldPan},
    {SceneClass::kObjects, kObjects, kHeldObjects}, {SceneClass::kThin, kThin, kHeldThin},
    {SceneClass::kLight, kLight, kHeldLight},       {SceneClass::kZoom, kZoom, kHeldZoom},
};

struct PointSamples {
  Samples flip, psnr, ms;
};

double deviation_of(const Samples& samples) {
  if (samples.size() < 2) return 0;
  return deviation_of_mean(samples) * std::sqrt(static_cast<double>(samples.size()));
}

PointSamples samples_of(std::span<const BenchResult> results, std::span<const std::string_view> scenes,
                        const Row& like) {
  PointSamples samples;
  for (const BenchResult& result : results) {
    const double megapixels = static_cast<double>(result.conditions.output.area()) * 1e-6;
    for (const Row& row : result.rows) {
      if (row.method != like.method || row.scale != like.scale) continue;
      if (std::find(scenes.begin(), scenes.end(), row.scene) == scenes.end()) continue;
      samples.flip.push_back(row.quality.flip);
      samples.psnr.push_back(std::min(row.quality.psnr, FrontPoint::kMaxPsnr));
      samples.ms.push_back(row.speed.least_ms.value_or(row.speed.ms.median) / megapixels);
    }
  }
  return samples;
}

std::string cell(const FrontPoint& point, const std::vector<FrontPoint>& front) {
  const bool on_front = std::find(front.begin(), front.end(), point) != front.end();
  return fmt::format("  {:.2f}:{:.4f} {:5.2f} {:6.2f}{}", point.scale, point.flip, point.psnr_db,
                     point.ms_per_megapixel, on_front ? '*' : ' ');
}

}  // namespace

std::span<const ClassScenes> class_scenes() {
  return kClasses;
}

Result<std::vector<FrontPoint>> front_points(std::span<const BenchResult> results) {
  std::vector<FrontPoint> points;
  for (const ClassScenes& members : class_scenes()) {
    for (const Row& row : results.front().rows) {
      if (row.scene != members.measured.front()) continue;
      const auto method = parse_variant(row.method);
      if (!method.ok()) return method.status();
      const PointSamples samples = samples_of(results, members.measured, row);
      points.push_back({.scene_class = members.scene_class,
                        .method = method.value(),
                        .scale = row.scale,
                        .flip = mean_of(samples.flip),
                        .flip_spread = deviation_of(samples.flip),
                        .psnr_db = mean_of(samples.psnr),
                        .psnr_spread = deviation_of(samples.psnr),
                        .ms_per_megapixel = mean_of(samples.ms),
                        .ms_spread = deviation_of(samples.ms)});
    }
  }
  return points;
}

std::string text_of(const ErrorFront& front) {
  std::string text = fmt::format(
      "{}\nscale:FLIP, dB, ms a megapixel of output; * is on the front of its class\n", front.summary());
  const FrontPoint* last = nullptr;
  std::vector<FrontPoint> of_class;
  for (const FrontPoint& point : front.points()) {
    const bool same_class = last != nullptr && last->scene_class == point.scene_class;
    if (!same_class) of_class = front.front(point.scene_class);
    if (!same_class || !(last->method == point.method))
      text +=
          fmt::format("\n{:<8} {:<21}", same_class ? "" : name_of(point.scene_class), name_of(point.method));
    text += cell(point, of_class);
    last = &point;
  }
  return text + "\n";
}

}  // namespace quincunx::bench
