// SPDX-License-Identifier: MIT
#include "bench/parts/parts_command.h"

#include <fmt/format.h>

#include "bench/parts/parts_rows.h"
#include "bench/speed_error/bench_machine.h"
#include "bench/speed_error/bench_options.h"
#include "tools/program/command_line.h"
#include "tools/program/date.h"
#include "tools/program/progress.h"

namespace quincunx::bench {
namespace {

constexpr float kPartScales[] = {0.75f, 0.5f, 0.25f, 0.125f};

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

// What all others are compared with comes first.
std::vector<PartCase> cases_of(const BenchPlan& plan, double base, bool has_particles) {
  std::vector<PartCase> cases = {{"picture", fmt::format("{:g}", base), base, {}}};
  for (const double scale : plan.scales) {
    if (scale != base) cases.push_back({"picture", fmt::format("{:g}", scale), scale, {}});
  }
  for (const float scale : kPartScales)
    cases.push_back({"shadow map", fmt::format("{:g}", scale), base, {.shadow = {.scale = scale}}});
  if (!has_particles) return cases;
  const auto add_particles = [&](float scale) {
    cases.push_back({"particles",
                     fmt::format("{:g}", scale),
                     base,
                     {.shadow = {}, .particles = scenes::PartSettings{.scale = scale}}});
  };
  add_particles(1);
  for (const float scale : kPartScales)
    add_particles(scale);
  return cases;
}

}  // namespace

void add_parts_options(tools::CommandLine& app, PartsOptions& options) {
  const auto parts = app.add_flag(
      "--parts", options.wanted,
      "Instead: what the scale of the picture, of its shadow map and of its particles cost and show");
  app.add_option("--base-scale", options.base_scale,
                 "With --parts: the picture's scale where a part's is changed (default: 0.71)")
      .in_range(0.02, 2.0)
      .needs(parts);
}

Result<PartsResult> run_parts(const BenchOptions& options) {
  auto plan = plan_of(options);
  if (!plan.ok()) return plan.status();
  const BenchMethod& method = plan->methods.front();
  scenes::FrameSourceSettings settings;
  settings.scene = plan->scenes.front();
  settings.seed = options.seed;
  settings.device = options.device;
  settings.interop = options.interop;
  settings.platform = options.platform;
  settings.sequence = sequence_for(plan.value(), 1, method);
  auto stage = scenes::FrameSource::create(settings);
  if (!stage.ok()) return stage.status();
  const scenes::Scene& scene = stage.value()->scene();
  plan->conditions = conditions_for(plan->conditions, scene);
  PartsResult result{.version = QUINCUNX_VERSION,
                     .command = options.command_line,
                     .date = tools::date_now(),
                     .scene = plan->scenes.front(),
                     .method = method.name,
                     .output = options.output,
                     .frames = plan->conditions.frames,
                     .machine = {},
                     .rows = {}};
  describe_machine(*stage.value(), result.machine);
  const auto truth =
      make_truth(stage.value()->renderer(), scene, result.machine.gl_version, plan->conditions);
  if (!truth.ok()) return truth.status();
  result.machine.load_before = load_of_last_minute();
  const auto cases =
      cases_of(plan.value(), options.parts_bench.base_scale, static_cast<bool>(scene.particles));
  using Show = tools::Progress::Show;
  tools::Progress progress("measuring", static_cast<std::int64_t>(cases.size()),
                           options.quiet ? Show::kNever : Show::kOnTerminal);
  for (const PartCase& wanted : cases) {
    auto row = measure_row({*stage.value(), plan.value(), truth.value()}, wanted);
    if (!row.ok()) return row.status();
    result.rows.push_back(std::move(row).value());
    progress.update(static_cast<std::int64_t>(result.rows.size()), wanted.part + " at " + wanted.label);
  }
  result.machine.load_after = load_of_last_minute();
  return result;
}

}  // namespace quincunx::bench
