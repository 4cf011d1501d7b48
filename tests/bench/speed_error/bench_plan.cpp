// SPDX-License-Identifier: MIT
#include "bench_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "scene_catalog.h"

namespace quincunx::bench {
namespace {

constexpr double kSmallestScale = 0.02;
constexpr double kLargestScale = 2;
constexpr int kSmallestSide = 16;  // the worst window has 16 x 16 pixels

Result<std::vector<BenchMethod>> chosen_methods(const std::vector<std::string>& names) {
  std::vector<BenchMethod> methods = all_methods();
  if (names.empty()) return methods;
  std::vector<BenchMethod> chosen;
  for (const std::string& name : names) {
    const auto found = std::find_if(methods.begin(), methods.end(),
                                    [&](const BenchMethod& method) { return method.name == name; });
    if (found == methods.end()) {
      std::string known;
      for (const BenchMethod& method : methods)
        known += (known.empty() ? "" : ", ") + method.name;
      return Status::invalid(fmt::format("--methods: there is no method '{}'; there are {}", name, known));
    }
    chosen.push_back(*found);
  }
  return chosen;
}

bool is_file(const std::string& name) {
  return name.ends_with(".gltf") || name.ends_with(".glb");
}

Result<std::vector<std::string>> chosen_scenes(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const scenes::SceneEntry& entry : scenes::list_scenes())
    known.push_back(entry.name);
  if (names.empty()) return known;
  for (const std::string& name : names) {
    if (is_file(name) || std::find(known.begin(), known.end(), name) != known.end()) continue;
    return Status::invalid(fmt::format(
        "--scenes: there is no scene '{}'; the built-in ones are {}; a file must end in .gltf or .glb", name,
        fmt::join(known, ", ")));
  }
  return names;
}

template <typename T>
Status check_once(const char* option, const std::vector<T>& values) {
  for (const T& value : values) {
    if (std::count(values.begin(), values.end(), value) > 1) {
      return Status::invalid(fmt::format("{}: '{}' is there twice", option, value));
    }
  }
  return {};
}

Status check_numbers(const BenchOptions& options) {
  for (const double scale : options.scales) {
    if (scale >= kSmallestScale && scale <= kLargestScale) continue;
    return Status::invalid(fmt::format("--scales: {} is no scale; it must lie between {} and {}", scale,
                                       kSmallestScale, kLargestScale));
  }
  if (options.output.width < kSmallestSide || options.output.height < kSmallestSide) {
    return Status::invalid(fmt::format("--output {}x{} is too small to measure; it must be at least {}x{}",
                                       options.output.width, options.output.height, kSmallestSide,
                                       kSmallestSide));
  }
  return {};
}

// The default method where it is measured, else the last.
std::size_t frame_method_of(const std::vector<BenchMethod>& methods) {
  const auto found = std::find_if(methods.begin(), methods.end(),
                                  [](const BenchMethod& method) { return method.is_default; });
  return found != methods.end() ? static_cast<std::size_t>(found - methods.begin()) : methods.size() - 1;
}

}  // namespace

Result<BenchPlan> plan_from(const BenchOptions& options) {
  if (Status status = check_numbers(options); !status.ok()) return status;
  for (const Status& status :
       {check_once("--methods", options.methods), check_once("--scenes", options.scenes),
        check_once("--scales", options.scales)}) {
    if (!status.ok()) return status;
  }
  auto methods = chosen_methods(options.methods);
  if (!methods.ok()) return methods.status();
  auto names = chosen_scenes(options.scenes);
  if (!names.ok()) return names.status();
  BenchPlan plan;
  plan.methods = std::move(methods).value();
  plan.frame_method = frame_method_of(plan.methods);
  plan.scenes = std::move(names).value();
  plan.scales = options.scales;
  std::sort(plan.scales.begin(), plan.scales.end());
  plan.conditions = {.output = options.output,
                     .frames = static_cast<int>(options.frames),
                     .warm_up = options.warm_up,
                     .rounds = options.rounds,
                     .truth_samples = options.truth,
                     .seed = options.seed,
                     .fps = options.fps,
                     .start = options.start};
  return plan;
}

scenes::SequenceSettings sequence_for(const BenchPlan& plan, double scale, const BenchMethod& method) {
  const Conditions& conditions = plan.conditions;
  scenes::SequenceSettings sequence;
  sequence.output = conditions.output;
  const auto axis = static_cast<float>(scale);
  sequence.scale_path = scenes::ScalePath::fixed({axis, axis}).value();  // plan_from() has checked it
  sequence.jitter = method.jitter;
  sequence.frames = conditions.warm_up + conditions.frames;
  sequence.fps = conditions.fps;
  sequence.start_seconds = conditions.start;
  sequence.lod_bias = method.lod_bias;
  return sequence;
}

double seconds_of(const Conditions& conditions, int index) {
  return conditions.start + index / conditions.fps;
}

}  // namespace quincunx::bench
