// SPDX-License-Identifier: MIT
#include "bench/resize/resize_command.h"

#include <algorithm>

#include "bench/resize/resize_costs.h"
#include "bench/resize/resize_frames.h"
#include "bench/speed_error/bench_machine.h"
#include "bench/speed_error/bench_options.h"
#include "bench/speed_error/bench_plan.h"
#include "tools/program/command_line.h"
#include "tools/program/date.h"

namespace quincunx::bench {
namespace {

constexpr const char* kRandomPath = "random:0.5,1";

// The plan checks names and numbers and knows the methods; here it is one of a scene and a method.
Result<BenchPlan> plan_of(BenchOptions options) {
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

void add_resize_options(tools::CommandLine& app, ResizeOptions& options) {
  const auto resize = app.add_flag(
      "--resize", options.wanted,
      "Instead: what another resolution costs, and frames with viewport and with placed targets");
  app.add_option("--resizes", options.resizes, "With --resize: resizes that are timed (default: 200)")
      .in_range(1, 1000000)
      .needs(resize);
}

Result<ResizeResult> run_resize(const BenchOptions& options) {
  auto plan = plan_of(options);
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
