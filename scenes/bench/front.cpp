// SPDX-License-Identifier: MIT
#include "bench/front.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "bench/bench_options.h"
#include "bench/harness/measuring.h"
#include "bench/speed_error/bench_plan.h"
#include "bench/speed_error/bench_run.h"
#include "bench/speed_error/bench_statistics.h"
#include "quincunx/control/front_file.h"
#include "quincunx/device.h"
#include "session/calibration.h"
#include "tools/program/atomic_file.h"
#include "tools/program/command_line.h"

namespace quincunx::bench {
namespace {

using Names = std::string_view[];

constexpr Names kStill = {"still"};
constexpr Names kPan = {"pan"};
constexpr Names kObjects = {"occluders", "wheel"};
constexpr Names kThin = {"wires", "cables"};
constexpr Names kLight = {"shadows", "sparkles"};
constexpr Names kZoom = {"zoom"};

constexpr Names kHeldStill = {"chart"};
constexpr Names kHeldPan = {"backdrop", "cut"};
constexpr Names kHeldObjects = {"courtyard", "cutout"};
constexpr Names kHeldThin = {"fence"};
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

constexpr double kLaterView = 2.5;  // seconds after the first

std::vector<std::string> measured_scenes() {
  std::vector<std::string> names;
  for (const ClassScenes& members : class_scenes())
    names.insert(names.end(), members.measured.begin(), members.measured.end());
  return names;
}

FrontSource source_of(const BenchResult& result) {
  const int samples = result.conditions.truth_samples;
  DeviceInfo device;
  device.platform = result.machine.cl_platform;
  device.name = result.machine.cl_device;
  device.driver = result.machine.cl_driver;
  const FrontKey key = front_key(device);
  return {.device = key.device,
          .driver = key.driver,
          .scene = key.scene,
          .date = result.date,
          .command = result.command,
          .truth = fmt::format("{} samples a pixel", samples * samples),
          .output_extent = result.conditions.output};
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

void apply_front_defaults(const tools::CommandLine& app, BenchOptions& options) {
  const auto unless_given = [&app](const char* option, auto& value, auto usual) {
    if (!app.has(option)) value = usual;
  };
  unless_given("--output", options.output, Extent{480, 270});
  unless_given("--scales", options.scales, std::vector<double>{0.35, 0.5, 0.71, 1});
  std::vector<std::string> methods;
  for (const MethodVariant& variant : scenes::front_variants())
    methods.push_back(name_of(variant));
  unless_given("--methods", options.methods, methods);
  unless_given("--frames", options.frames, 2);
  unless_given("--rounds", options.rounds, 3);
  unless_given("--truth", options.truth, 6);
}

ErrorFront measure_front(const BenchOptions& options) {
  BenchOptions view = options;
  view.scenes = measured_scenes();
  std::vector<BenchResult> results;
  for (int later = 0; later < 2; ++later) {
    view.start = options.start + later * kLaterView;
    view.seed = options.seed + static_cast<std::uint64_t>(later);
    results.push_back(run_bench(checked(plan_from(view)), view).result);
  }
  return checked(ErrorFront::create(source_of(results.front()), checked(front_points(results))));
}

void write_front(const BenchOptions& options, const ErrorFront& front) {
  const std::string text = front.to_json();
  checked(tools::write_text(options.front.file, text));
  const FrontSource& source = front.source();
  const auto path = front_path({source.device, source.driver, source.scene});
  if (!path) return;
  const Status status = tools::write_text(path->string(), text);
  if (!status.ok()) spdlog::warn("the front is not kept for other programs: {}", status.message());
}

}  // namespace quincunx::bench
