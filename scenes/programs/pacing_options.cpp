// SPDX-License-Identifier: MIT
#include "pacing_options.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "tools/option_choice.h"

namespace quincunx::scenes {
namespace {

void add_controller_options(CLI::App& app, PacingOptions& options) {
  static const std::map<std::string, ControllerKind> kControllers = {
      {"predictive", ControllerKind::kPredictive},
      {"proportional", ControllerKind::kProportional},
      {"minimum-of-n", ControllerKind::kMinimumOfN},
      {"fixed", ControllerKind::kFixed}};
  static const std::map<std::string, AxisOrder> kOrders = {{"horizontal-first", AxisOrder::kHorizontalFirst},
                                                           {"horizontal-only", AxisOrder::kHorizontalOnly},
                                                           {"both", AxisOrder::kBoth}};
  static const std::map<std::string, FrameCost> kCosts = {
      {"auto", FrameCost::kAuto}, {"device", FrameCost::kDevice}, {"span", FrameCost::kSpan}};
  tools::add_choice(
      app, "--controller", options.controller, kControllers,
      "With --target-fps: predictive (default), proportional, minimum-of-n, or fixed: none, only the "
      "report");
  tools::add_choice(app, "--ladder", options.order, kOrders,
                    "With a controller: horizontal-first (default), horizontal-only or both");
  tools::add_choice(
      app, "--frame-cost", options.cost, kCosts,
      "What a frame costs: device (timers of OpenGL and OpenCL), span (until its picture is complete) "
      "or auto (default: device where OpenGL's timers can be trusted)");
}

}  // namespace

void add_pacing_options(CLI::App& app, PacingOptions& options, CLI::Option* scale, CLI::Option* scale_path) {
  auto* target = app.add_option("--target-fps", options.target_fps,
                                "Hold this rate: a controller chooses each frame's resolution")
                     ->check([](const std::string& text) {
                       double fps = 0;
                       const bool good =
                           CLI::detail::lexical_cast(text, fps) && fps > 0 && std::isfinite(fps);
                       return good ? std::string() : fmt::format("'{}' is no positive finite number", text);
                     })
                     ->type_name("F");
  add_controller_options(app, options);
  for (const char* name : {"--controller", "--ladder", "--frame-cost"})
    app.get_option(name)->needs(target);
  app.add_option("--min-scale", options.min_scale, "Lowest scale that a controller may choose, per axis")
      ->check(CLI::Range(0.01, 2.0))
      ->needs(target)
      ->capture_default_str();
  app.add_option("--max-scale", options.max_scale, "Highest scale that a controller may choose")
      ->check(CLI::Range(0.01, 2.0))
      ->needs(target)
      ->capture_default_str();
  app.add_option("--buffers", options.buffers, "Of the display that frames are made for")
      ->check(CLI::Range(2, 8))
      ->needs(target)
      ->capture_default_str();
  app.add_option("--headroom", options.headroom, "Part of the refresh interval that a controller leaves free")
      ->check(CLI::Range(0.0, 0.5))
      ->needs(target)
      ->capture_default_str();
  app.add_option(
         "--compare-fixed", options.compared_scales,
         "Draw the same frames again at each of these fixed scales; the report sets them side by side")
      ->check(CLI::Range(0.01, 2.0))
      ->delimiter(',')
      ->needs(target)
      ->type_name("S,S");
  app.parse_complete_callback([&options, scale, scale_path] {
    if (!options.controls()) return;
    const CLI::Option* given = scale->count() > 0 ? scale : scale_path;
    if (given->count() == 0) return;
    throw CLI::ValidationError(
        given->get_name(),
        fmt::format(
            "the {} controller chooses the scale; bound it by --min-scale and --max-scale, or ask for "
            "--controller fixed",
            name_of(options.controller)));
  });
}

Result<std::optional<FramePacing>> frame_pacing_for(const PacingOptions& options, Extent output) {
  if (!options.on()) return std::optional<FramePacing>();
  if (options.min_scale > options.max_scale) {
    return Status::invalid(
        fmt::format("--min-scale {} is above --max-scale {}", options.min_scale, options.max_scale));
  }
  PacingSettings settings;
  settings.controller = options.controller;
  settings.ladder = {.output = output,
                     .min_scale = options.min_scale,
                     .max_scale = options.max_scale,
                     .order = options.order};
  settings.target_fps = options.target_fps;
  settings.buffers = options.buffers;
  settings.headroom = options.headroom;
  auto pacing = FramePacing::create(settings);
  if (!pacing.ok()) return pacing.status();
  return std::optional<FramePacing>(std::move(pacing).value());
}

}  // namespace quincunx::scenes
