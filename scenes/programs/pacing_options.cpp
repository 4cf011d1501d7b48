// SPDX-License-Identifier: MIT
#include "programs/pacing_options.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <map>
#include <utility>

#include "tools/program/command_line.h"

namespace quincunx::scenes {
namespace {

Result<CostTable> read_calibration(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) return Status::io(fmt::format("--calibration: '{}' cannot be read", path));
  auto table = CostTable::from_json(text);
  if (!table.ok()) {
    return Status::invalid(fmt::format("--calibration: '{}': {}", path, table.status().message()));
  }
  return table;
}

std::string positive_finite(const std::string& text) {
  const std::optional<double> value = tools::number_in(text);
  const bool good = value && *value > 0 && std::isfinite(*value);
  return good ? std::string() : fmt::format("'{}' is no positive finite number", text);
}

void refuse_given(tools::CommandLine& app, std::initializer_list<std::string> names, const std::string& why) {
  for (const std::string& name : names) {
    if (app.has(name)) throw tools::UsageError{name, why};
  }
}

void add_controller_options(tools::CommandLine& app, PacingOptions& options) {
  static const std::map<std::string, ControllerKind> kControllers = {
      {"predictive", ControllerKind::kPredictive},
      {"proportional", ControllerKind::kProportional},
      {"minimum-of-n", ControllerKind::kMinimumOfN},
      {"quality", ControllerKind::kQuality},
      {"fixed", ControllerKind::kFixed}};
  tools::add_choice(app, "--controller", options.controller, kControllers,
                    "With --target-fps: predictive (default), proportional, minimum-of-n, quality (chooses "
                    "the method, too), "
                    "or fixed: none, only the report");
  app.add_option("--calibration", options.calibration,
                 "For the predictive and the quality controller: what --calibrate wrote")
      .type_name("FILE");
  app.add_flag_callback(
      "--follow-cpu", [&options] { options.cpu_bound = CpuBound::kFollow; },
      "Where the processor takes longer than the target, the predictive or quality controller makes its time "
      "the target");
  app.add_flag("--blur-aware", options.blur_aware,
               "The longer the streaks that the camera's motion draws, the lower the highest resolution "
               "(predictive, quality)")
      .needs("--blur");
  app.add_flag(
      "--detail-follows", options.detail_follows,
      "Where the resolution is low, small surfaces are left out and moving shadows drawn less often");
}

void add_ladder_options(tools::CommandLine& app, PacingOptions& options) {
  static const std::map<std::string, AxisOrder> kOrders = {{"horizontal-first", AxisOrder::kHorizontalFirst},
                                                           {"horizontal-only", AxisOrder::kHorizontalOnly},
                                                           {"both", AxisOrder::kBoth}};
  tools::add_choice(app, "--ladder", options.order, kOrders,
                    "With a controller: horizontal-first (default), horizontal-only or both");
  app.add_option("--min-scale", options.min_scale, "Lowest scale that a controller may choose, per axis")
      .in_range(0.01, 2.0)
      .show_default();
  app.add_option("--max-scale", options.max_scale, "Highest scale that a controller may choose")
      .in_range(0.01, 2.0)
      .show_default();
}

void add_display_options(tools::CommandLine& app, PacingOptions& options) {
  app.add_option("--buffers", options.buffers, "Of the display that frames are made for")
      .in_range(2, 8)
      .show_default();
  app.add_option("--headroom", options.headroom, "Part of the refresh interval that a controller leaves free")
      .in_range(0.0, 0.5)
      .show_default();
  app.add_option(
         "--compare-fixed", options.compared_scales,
         "Draw the same frames again at each of these fixed scales; the report sets them side by side")
      .in_range(0.01, 2.0)
      .delimiter(',')
      .type_name("S,S");
}

void add_measuring_options(tools::CommandLine& app, PacingOptions& options) {
  static const std::map<std::string, FrameCost> kCosts = {
      {"auto", FrameCost::kAuto}, {"device", FrameCost::kDevice}, {"span", FrameCost::kSpan}};
  tools::add_choice(
      app, "--frame-cost", options.cost, kCosts,
      "What a frame costs: device (timers of OpenGL and OpenCL), span (until its picture is complete) "
      "or auto (default: device where the timers of both can be trusted)");
  app.add_option(
         "--calibrate", options.calibrate,
         "Measure instead what frames cost at a few resolutions, and write it for --calibration; then "
         "what each method errs and costs in this scene, and keep it in the cache folder")
      .excludes("--target-fps")
      .type_name("FILE");
  app.add_option(
         "--truth-seconds", options.truth_seconds,
         "With --calibrate: the longest that truth may take; beyond it errors are against the best method")
      .in_range(0.0, 3600.0)
      .needs("--calibrate")
      .show_default();
}

// What fits together, where it is more than one option needing another.
void check_together(tools::CommandLine& app, const PacingOptions& options) {
  if (options.has_ladder()) {
    refuse_given(app, {"--scale", "--scale-path"},
                 "here the resolution is chosen for you; bound it by --min-scale and --max-scale, or ask for "
                 "--controller fixed");
  } else {
    refuse_given(app, {"--ladder", "--min-scale", "--max-scale"},
                 "nothing chooses the resolution; give --target-fps with a controller, or --calibrate");
  }
  if (options.controller != ControllerKind::kPredictive && options.controller != ControllerKind::kQuality) {
    refuse_given(app, {"--calibration", "--follow-cpu", "--blur-aware"},
                 "only the predictive and the quality controller make use of it");
  }
  if (options.chooses_method()) {
    refuse_given(
        app, {"--method", "--view", "--jitter"},
        "here the method is chosen for you, and with it the jitter; ask for --controller predictive");
    refuse_given(app, {"--focus", "--dual"},
                 "--controller quality works without it: no front has its errors and its times; ask for "
                 "--controller predictive");
    refuse_given(app, {"--compare-fixed"},
                 "runs at fixed scales have one method; ask for --controller predictive with that --method");
  }
}

}  // namespace

void add_pacing_options(tools::CommandLine& app, PacingOptions& options) {
  const auto target = app.add_option("--target-fps", options.target_fps,
                                     "Hold this rate: a controller chooses each frame's resolution")
                          .check(positive_finite)
                          .type_name("F");
  add_controller_options(app, options);
  add_ladder_options(app, options);
  add_display_options(app, options);
  for (const char* name : {"--controller", "--calibration", "--follow-cpu", "--blur-aware",
                           "--detail-follows", "--buffers", "--headroom", "--compare-fixed"}) {
    app.option(name).needs(target);
  }
  add_measuring_options(app, options);
  app.when_read([&app, &options] { check_together(app, options); });
}

Result<LadderSettings> ladder_for(const PacingOptions& options, Extent output) {
  if (options.min_scale > options.max_scale) {
    return Status::invalid(
        fmt::format("--min-scale {} is above --max-scale {}", options.min_scale, options.max_scale));
  }
  return LadderSettings{.output = output,
                        .min_scale = options.min_scale,
                        .max_scale = options.max_scale,
                        .order = options.order};
}

Result<std::optional<FramePacing>> frame_pacing_for(const PacingOptions& options, Extent output,
                                                    const ErrorFront& front) {
  if (!options.on()) return std::optional<FramePacing>();
  const auto ladder = ladder_for(options, output);
  if (!ladder.ok()) return ladder.status();
  PacingSettings settings;
  settings.controller = options.controller;
  settings.ladder = ladder.value();
  settings.target_fps = options.target_fps;
  settings.buffers = options.buffers;
  settings.headroom = options.headroom;
  settings.cpu_bound = options.cpu_bound;
  settings.blur_aware.enabled = options.blur_aware;
  settings.front = front;
  if (!options.calibration.empty()) {
    auto table = read_calibration(options.calibration);
    if (!table.ok()) return table.status();
    settings.calibration = std::move(table).value();
  }
  auto pacing = FramePacing::create(settings);
  if (!pacing.ok()) return pacing.status();
  return std::optional<FramePacing>(std::move(pacing).value());
}

}  // namespace quincunx::scenes
