// SPDX-License-Identifier: MIT
#include "bench/resize/resize_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "bench/bench_options.h"
#include "bench/resize/resize_costs.h"
#include "bench/speed_error/bench_machine.h"
#include "bench/speed_error/bench_plan.h"
#include "tools/program/program.h"

namespace quincunx::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMebi = 1 << 20;

Json json_of(const Quantiles& quantiles) {
  return {{"min", quantiles.least}, {"median", quantiles.median}, {"p95", quantiles.p95}};
}

Json json_of(const TargetFrames& row) {
  return {{"scale", row.scale},
          {"targets", name_of(row.targets)},
          {"render", {row.render.width, row.render.height}},
          {"draw_ms", json_of(row.draw_ms)},
          {"interop_ms", json_of(row.interop_ms)},
          {"resolve_ms", json_of(row.resolve_ms)},
          {"frame_ms", json_of(row.frame_ms)},
          {"frame_processor_ms", row.processor_ms},
          {"gl_bytes", row.gl_bytes},
          {"opencl_bytes", row.opencl_bytes}};
}

constexpr const char* kRandomPath = "random:0.5,1";

// The plan checks names and numbers and knows the methods; here it is one of a scene and a method.
Result<BenchPlan> resize_plan_of(BenchOptions options) {
  if (options.methods.empty()) {
    for (const BenchMethod& method : all_methods()) {
      if (method.is_default) options.methods = {method.name};
    }
  }
  if (options.scenes.empty()) options.scenes = {"courtyard"};
  options.scenes.resize(1);
  options.methods.resize(1);
  return plan_from(options);
}

Result<std::unique_ptr<scenes::FrameSource>> open_stage(const BenchPlan& plan, const BenchOptions& options) {
  scenes::FrameSourceSettings settings;
  settings.scene = plan.scenes.front();
  settings.seed = options.seed;
  settings.device = options.device;
  settings.interop = options.interop;
  settings.platform = options.platform;
  settings.sequence = sequence_for(plan, 1, plan.methods.front());
  return scenes::FrameSource::create(settings);
}

}  // namespace

Quantiles quantiles_of(const Samples& samples) {
  if (samples.empty()) return {};
  return {*std::min_element(samples.begin(), samples.end()), median_of(samples), p95_of(samples)};
}

std::string text_of(const ResizeResult& result) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{}, {} -> {}x{}, {}, {}, load {:.1f} to {:.1f}\n", result.scene, result.method,
                 result.output.width, result.output.height, result.machine.cl_device,
                 result.machine.gl_renderer, result.machine.load_before, result.machine.load_after);
  fmt::format_to(out, "\nA resize, {} of each\n{:<13}{:>9}{:>9}{:>9}{:>12}{:>8}{:>8}  us; first use in ms\n",
                 result.resizes, "way", "min", "median", "p95", "first min", "median", "p95");
  for (const ResizeCost& cost : result.costs) {
    fmt::format_to(out, "{:<13}{:>9.2f}{:>9.2f}{:>9.2f}{:>12.3f}{:>8.3f}{:>8.3f}  {}\n", cost.name,
                   cost.resize_us.least, cost.resize_us.median, cost.resize_us.p95, cost.first_ms.least,
                   cost.first_ms.median, cost.first_ms.p95, cost.what);
  }
  fmt::format_to(out, "\nFrames, {} of each\n{:<8}{:<10}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>11}{:>10}{:>10}\n",
                 result.frames, "scale", "targets", "draw", "interop", "resolve", "frame", "min", "p95",
                 "processor", "GL MiB", "CL MiB");
  for (const TargetFrames& row : result.rows) {
    fmt::format_to(
        out, "{:<8}{:<10}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>11.2f}{:>10.1f}{:>10.1f}\n",
        row.scale, name_of(row.targets), row.draw_ms.median, row.interop_ms.median, row.resolve_ms.median,
        row.frame_ms.median, row.frame_ms.least, row.frame_ms.p95, row.processor_ms,
        static_cast<double>(row.gl_bytes) / kMebi, static_cast<double>(row.opencl_bytes) / kMebi);
  }
  text +=
      "\nms, medians but for min and p95, which are the frame's; processor: of all threads.  random: "
      "another size in each frame.\n";
  return text;
}

std::string json_of(const ResizeResult& result) {
  Json root = {{"version", result.version},
               {"command", result.command},
               {"date", result.date},
               {"scene", result.scene},
               {"method", result.method},
               {"output", {result.output.width, result.output.height}},
               {"resizes", result.resizes},
               {"frames", result.frames},
               {"machine", json_of(result.machine)},
               {"costs", Json::array()},
               {"rows", Json::array()}};
  for (const ResizeCost& cost : result.costs) {
    root["costs"].push_back({{"way", cost.name},
                             {"what", cost.what},
                             {"resize_us", json_of(cost.resize_us)},
                             {"first_use_ms", json_of(cost.first_ms)}});
  }
  for (const TargetFrames& row : result.rows)
    root["rows"].push_back(json_of(row));
  return root.dump(1) + "\n";
}

std::string csv_of(const ResizeResult& result) {
  std::string text =
      "scale,targets,draw_ms,interop_ms,resolve_ms,frame_ms,frame_min_ms,frame_p95_ms,frame_processor_ms,"
      "gl_bytes,opencl_bytes\n";
  for (const TargetFrames& row : result.rows) {
    text +=
        fmt::format("{},{},{:g},{:g},{:g},{:g},{:g},{:g},{:g},{},{}\n", row.scale, name_of(row.targets),
                    row.draw_ms.median, row.interop_ms.median, row.resolve_ms.median, row.frame_ms.median,
                    row.frame_ms.least, row.frame_ms.p95, row.processor_ms, row.gl_bytes, row.opencl_bytes);
  }
  return text;
}

Result<ResizeResult> run_resize(const BenchOptions& options) {
  auto plan = resize_plan_of(options);
  if (!plan.ok()) return plan.status();
  auto stage = open_stage(plan.value(), options);
  if (!stage.ok()) return stage.status();
  const BenchMethod& method = plan->methods.front();
  ResizeResult result{.version = QUINCUNX_VERSION,
                      .command = options.command_line,
                      .date = tools::date_now(),
                      .scene = plan->scenes.front(),
                      .method = method.name,
                      .output = options.output,
                      .resizes = options.resize.resizes,
                      .frames = static_cast<int>(options.frames) * options.rounds,
                      .machine = {},
                      .costs = {},
                      .rows = {}};
  describe_machine(*stage.value(), result.machine);
  result.machine.interop = "copy";
  result.machine.load_before = load_of_last_minute();
  auto costs = measure_resizes(*stage.value(), {options.output, options.resize.resizes, options.seed});
  if (!costs.ok()) return costs.status();
  result.costs = std::move(costs).value();
  TargetFramesSettings settings{.output = options.output,
                                .method = method,
                                .scale_path = {},
                                .warm_up = options.warm_up,
                                .frames = result.frames,
                                .seed = options.seed,
                                .fps = options.fps};
  const auto add = [&]() -> Status {
    auto rows = measure_frames(*stage.value(), settings);
    if (!rows.ok()) return rows.status();
    result.rows.insert(result.rows.end(), rows->begin(), rows->end());
    return {};
  };
  for (const double scale : plan->scales) {
    settings.scale = scale;
    if (Status status = add(); !status.ok()) return status;
  }
  settings.scale_path = kRandomPath;
  if (Status status = add(); !status.ok()) return status;
  result.machine.load_after = load_of_last_minute();
  return result;
}

}  // namespace quincunx::bench
