// SPDX-License-Identifier: MIT
#include "bench/front/front_command.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "bench/bench_options.h"
#include "bench/front/front_points.h"
#include "bench/speed_error/bench_plan.h"
#include "bench/speed_error/bench_run.h"
#include "quincunx/control/front_file.h"
#include "quincunx/device.h"
#include "session/calibration.h"
#include "tools/program/atomic_file.h"
#include "tools/program/command_line.h"

namespace quincunx::bench {
namespace {

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

Result<ErrorFront> measure_front(const BenchOptions& options) {
  BenchOptions view = options;
  view.scenes = measured_scenes();
  std::vector<BenchResult> results;
  for (int later = 0; later < 2; ++later) {
    view.start = options.start + later * kLaterView;
    view.seed = options.seed + static_cast<std::uint64_t>(later);
    auto plan = plan_from(view);
    if (!plan.ok()) return plan.status();
    auto run = run_bench(plan.value(), view);
    if (!run.ok()) return run.status();
    results.push_back(std::move(run->result));
  }
  auto points = front_points(results);
  if (!points.ok()) return points.status();
  return ErrorFront::create(source_of(results.front()), std::move(points).value());
}

Status write_front(const BenchOptions& options, const ErrorFront& front) {
  const std::string text = front.to_json();
  if (Status status = tools::write_text(options.front.file, text); !status.ok()) return status;
  const FrontSource& source = front.source();
  const auto path = front_path({source.device, source.driver, source.scene});
  if (!path) return {};
  const Status status = tools::write_text(path->string(), text);
  if (!status.ok()) spdlog::warn("the front is not kept for other programs: {}", status.message());
  return {};
}

}  // namespace quincunx::bench
