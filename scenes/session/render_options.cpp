// SPDX-License-Identifier: MIT
#include "session/render_options.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <map>
#include <utility>

#include "tools/program/command_line.h"
#include "tools/program/program.h"

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

// Refuses options that do not fit together, where it is more than one option needing another.
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

// After --scale and --scale-path, with which they are checked.
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

constexpr const char* kExamples = R"(Examples:
  quincunx-render --out courtyard.png                               one frame of the default scene at 1280x720
  quincunx-render --scale-path sweep --frames 240 --out "out/frame.%04d.png" --report out/report
  quincunx-render --scene model.glb --scale 0.5 --method bilinear --frames 60 --out "orbit.%04d.exr"
  quincunx-render --scale 0.5 --frames 60 --score 4 --report out/report   pictures and scores against truth
  quincunx-render --scene wheel --truth 8 --shutter 0.5 --out truth.exr   supersampled, half a frame's shutter
  quincunx-render --target-fps 30 --frames 300 --report pace        a controller holds the rate; the report has how
  quincunx-render --scene chart --scale 0.71 --explain                what this scene needs and what is left out
  quincunx-render --window --scale 0.71                               in a window; H there lists the keys
Exit status: 0 done, 1 failed, 2 wrong usage.)";

void add_run_options(tools::CommandLine& app, RenderOptions& options) {
  app.add_option("--truth", options.truth,
                 "Supersampled truth instead: N x N samples a pixel at output size, box")
      .in_range(1, 64)
      .excludes("--colour")
      .excludes("--target-fps")
      .excludes("--calibrate")
      .type_name("N");
  app.add_option("--shutter", options.shutter,
                 "With --truth: part of the frame's time that the shutter is open")
      .in_range(0.0, 1.0)
      .needs("--truth");
  app.add_option("--score", options.score,
                 "Score each frame against a truth of N x N samples a pixel; --report shows some beside it")
      .in_range(1, 64)
      .excludes("--truth")
      .excludes("--calibrate")
      .type_name("N");
  app.add_option("--out", options.out,
                 "Frames to write: .png (presented) or .exr (linear); #, @ or %04d is the number")
      .type_name("PATTERN");
  app.add_option("--contact-sheet", options.contact_sheet, "One PNG that shows the whole run")
      .type_name("FILE");
  app.add_option("--exr-frame", options.exr_frame,
                 "Write this frame's targets and resolved picture as EXR beside --out")
      .non_negative()
      .type_name("N");
  app.add_option("--report", options.report,
                 "Write BASE.html, .txt and .json: passes, bytes, viewports, devices, scores")
      .type_name("BASE");
  app.add_flag("!--no-overlap", options.overlap,
               "Finish each frame before the next: slower, cleaner pass times");
  app.add_flag("--explain", options.explain,
               "Print the plan (passes, variants, buffers, bytes, what is left out) and stop");
  app.add_flag("--json", options.json, "Print the report as JSON on standard output");
}

// After all options that it excludes.
void add_why_option(tools::CommandLine& app, RenderOptions& options) {
  const auto why =
      app.add_option("--why", options.why,
                     "One PNG instead: three places of the scene by bilinear, quincunx and temporal, at "
                     "half the size or --scale, beside truth")
          .type_name("FILE");
  for (const char* other : {"--method",    "--jitter", "--view",   "--frames",  "--scale-path",
                            "--dual",      "--focus",  "--colour", "--shading", "--target-fps",
                            "--calibrate", "--truth",  "--score",  "--out",     "--contact-sheet",
                            "--exr-frame", "--report", "--json",   "--window",  "--explain"}) {
    why.excludes(app.option(other));
  }
}

void add_window_options(tools::CommandLine& app, RenderOptions& options) {
  const auto window = app.add_flag("--window", options.window,
                                   "Show the frames in a window, until it is closed or --frames are shown");
  for (const char* other : {"--truth", "--score", "--out", "--contact-sheet", "--exr-frame", "--report",
                            "--json", "--calibrate", "--compare-fixed"}) {
    window.excludes(app.option(other));
  }
  app.add_option("--script", options.script, "Keys and sizes for the window, by frame; docs/programs.md")
      .needs(window)
      .type_name("FILE");
  app.add_option("--captures", options.captures, "Folder of the window's screenshots and dumps")
      .needs(window)
      .show_default()
      .type_name("FOLDER");
  app.add_flag("!--hide-ui", options.show_ui, "Begin with the picture alone; Tab shows the panel")
      .needs(window);
  app.add_flag("!--no-vsync", options.vsync, "Show pictures without waiting for the display").needs(window);
}

}  // namespace

Result<LadderSettings> ladder_for(const PacingOptions& options, Extent output) {
  if (options.min_scale > options.max_scale) {
    return Status::invalid(
        fmt::format("--min-scale {} is above --max-scale {}", options.min_scale, options.max_scale));
  }
  return LadderSettings{.output_extent = output,
                        .min_scale = options.min_scale,
                        .max_scale = options.max_scale,
                        .order = options.order};
}

Result<FramePacing> frame_pacing_for(const PacingOptions& options, Extent output, const ErrorFront& front) {
  if (!options.on()) return FramePacing::free_running(output);
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
  return FramePacing::create(settings);
}

std::optional<int> parse_command_line(int argc, char** argv, RenderOptions& options) {
  tools::CommandLine app(
      "Renders a scene at a dynamic resolution with OpenGL and makes the picture from it with OpenCL.",
      "quincunx-render", QUINCUNX_VERSION, kExamples);
  add_picture_options(app, options);
  add_pacing_options(app, options.pacing);
  add_run_options(app, options);
  add_window_options(app, options);
  add_why_option(app, options);
  add_machine_options(app, options);
  options.command_line = tools::command_line_text("quincunx-render", argc, argv);
  if (const std::optional<int> code = app.parse(argc, argv)) return code;
  // Held at its rate, the scene goes at its own speed.
  if (options.pacing.on() && !app.has("--fps")) options.fps = options.pacing.target_fps;
  // The targets hold whatever a controller may choose.
  if (options.pacing.has_ladder()) options.scale = fmt::format("{}", options.pacing.max_scale);
  if (!options.why.empty() && !app.has("--scale")) options.scale = "0.5";
  if (options.window && !app.has("--frames")) options.frames = 0;
  return std::nullopt;
}

}  // namespace quincunx::scenes
