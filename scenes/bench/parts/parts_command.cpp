// SPDX-License-Identifier: MIT
#include "bench/parts/parts_command.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "bench/bench_options.h"
#include "bench/parts/parts_rows.h"
#include "bench/speed_error/bench_machine.h"
#include "tools/program/program.h"

namespace quincunx::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLeastSaving = 0.01;  // share of the first row's time: less is noise

Json json_of(const PartTimes& times) {
  return {{"ms", times.ms}, {"processor_ms", times.processor_ms}};
}

// JSON has no NaN.
Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

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

// Returns the cases in order; the first is the one that all others are compared with.
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

PartChange change_of(const PartRow& row, const PartRow& base) {
  PartChange change{.saved_processor_ms = base.frame.processor_ms - row.frame.processor_ms,
                    .flip = row.flip - base.flip};
  const bool saves = change.saved_processor_ms > kLeastSaving * base.frame.processor_ms;
  change.flip_per_ms =
      saves ? change.flip / change.saved_processor_ms : std::numeric_limits<double>::quiet_NaN();
  return change;
}

std::string text_of(const PartsResult& result) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{}, {} -> {}x{}, {}, {}, load {:.1f} to {:.1f}, {} frames of each\n\n", result.scene,
                 result.method, result.output.width, result.output.height, result.machine.cl_device,
                 result.machine.gl_renderer, result.machine.load_before, result.machine.load_after,
                 result.frames);
  fmt::format_to(out, "{:<12}{:<10}{:>9}{:>9}{:>9}{:>9}{:>9}{:>8}{:>9}{:>9}{:>10}{:>13}\n", "part", "scale",
                 "draw", "resolve", "frame", "draw", "resolve", "frame", "PSNR", "FLIP", "saves",
                 "FLIP a ms");
  for (const PartRow& row : result.rows) {
    const PartChange change = change_of(row, result.rows.front());
    const std::string exchange =
        std::isfinite(change.flip_per_ms) ? fmt::format("{:+.6f}", change.flip_per_ms) : "-";
    fmt::format_to(
        out, "{:<12}{:<10}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>8.2f}{:>9.2f}{:>9.4f}{:>10.2f}{:>13}\n",
        row.part, row.scale, row.draw.ms, row.resolve.ms, row.frame.ms, row.draw.processor_ms,
        row.resolve.processor_ms, row.frame.processor_ms, row.psnr, row.flip, change.saved_processor_ms,
        exchange);
  }
  text +=
      "\nms, medians: first by the host's clock, then of the processor, all threads; \"saves\" and \"FLIP a "
      "ms\" "
      "are\nof the latter, against the first row: the mean FLIP that a saved millisecond costs.\n";
  return text;
}

std::string json_of(const PartsResult& result) {
  Json root = {{"version", result.version}, {"command", result.command},
               {"date", result.date},       {"scene", result.scene},
               {"method", result.method},   {"output", {result.output.width, result.output.height}},
               {"frames", result.frames},   {"machine", json_of(result.machine)},
               {"rows", Json::array()}};
  for (const PartRow& row : result.rows) {
    const PartChange change = change_of(row, result.rows.front());
    root["rows"].push_back({{"part", row.part},
                            {"scale", row.scale},
                            {"render", {row.render.width, row.render.height}},
                            {"draw", json_of(row.draw)},
                            {"resolve", json_of(row.resolve)},
                            {"frame", json_of(row.frame)},
                            {"psnr", number_or_null(row.psnr)},
                            {"flip", row.flip},
                            {"saved_processor_ms", change.saved_processor_ms},
                            {"flip_per_ms", number_or_null(change.flip_per_ms)}});
  }
  return root.dump(1) + "\n";
}

std::string csv_of(const PartsResult& result) {
  std::string text =
      "part,scale,draw_ms,resolve_ms,frame_ms,draw_processor_ms,resolve_processor_ms,frame_processor_ms,psnr,"
      "flip\n";
  for (const PartRow& row : result.rows) {
    text += fmt::format("{},{},{:g},{:g},{:g},{:g},{:g},{:g},{:g},{:g}\n", row.part, row.scale, row.draw.ms,
                        row.resolve.ms, row.frame.ms, row.draw.processor_ms, row.resolve.processor_ms,
                        row.frame.processor_ms, row.psnr, row.flip);
  }
  return text;
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
