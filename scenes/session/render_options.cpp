// SPDX-License-Identifier: MIT
#include "session/render_options.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "tools/image/image_io.h"
#include "tools/program/atomic_file.h"
#include "tools/program/command_line.h"
#include "tools/program/program.h"

namespace quincunx::scenes {
namespace {

Result<CostTable> read_calibration(const std::string& path) {
  const auto text = tools::read_text(path);
  if (!text.ok()) return Status::io("--calibration: " + text.error());
  auto table = CostTable::from_json(text.value());
  if (!table.ok()) {
    return Status::invalid(fmt::format("--calibration: '{}': {}", path, table.status().message()));
  }
  return table;
}

// Refuses options that do not fit together, where it is more than one option needing another.
void check_together(const tools::CommandLine& line, const PacingOptions& options) {
  if (options.has_ladder()) {
    line.refuse({"--scale", "--scale-path"},
                "here the resolution is chosen for you; bound it by --min-scale and --max-scale, or ask for "
                "--controller fixed");
  } else {
    line.refuse({"--ladder", "--min-scale", "--max-scale"},
                "nothing chooses the resolution; give --target-fps with a controller, or --calibrate");
  }
  if (options.min_scale > options.max_scale)
    throw tools::UsageError{
        "", fmt::format("--min-scale {} is above --max-scale {}", options.min_scale, options.max_scale)};
  if (options.chooses_method()) {
    line.refuse({"--method", "--view", "--jitter"},
                "here the method is chosen for you, and with it the jitter; ask for --controller predictive");
    line.refuse({"--focus", "--dual"},
                "--controller quality works without it: no front has its errors and its times; ask for "
                "--controller predictive");
    line.refuse({"--compare-fixed"},
                "runs at fixed scales have one method; ask for --controller predictive with that --method");
  }
}

void add_pacing_options(tools::CommandLine& line, PacingOptions& options) {
  static const std::map<std::string, ControllerKind> kControllers = {
      {"predictive", ControllerKind::kPredictive},
      {"proportional", ControllerKind::kProportional},
      {"minimum-of-n", ControllerKind::kMinimumOfN},
      {"quality", ControllerKind::kQuality},
      {"fixed", ControllerKind::kFixed}};
  static const std::map<std::string, AxisOrder> kOrders = {{"horizontal-first", AxisOrder::kHorizontalFirst},
                                                           {"horizontal-only", AxisOrder::kHorizontalOnly},
                                                           {"both", AxisOrder::kBoth}};
  static const std::map<std::string, FrameCost> kCosts = {
      {"auto", FrameCost::kAuto}, {"device", FrameCost::kDevice}, {"span", FrameCost::kSpan}};
  constexpr tools::Bounds kScales = {.least = 0.01, .most = 2};
  const auto predicts = [&options] {
    return options.controller == ControllerKind::kPredictive ||
           options.controller == ControllerKind::kQuality;
  };
  constexpr const char* kPredicting = "--controller predictive or quality";
  line.group("Control");
  line.add("--target-fps", tools::number(options.target_fps, {.least = 0, .most = 1e6, .beyond = true}, "F"),
           "Hold this rate: a controller chooses each frame's resolution")
      .common();
  line.add("--controller", tools::choice(options.controller, kControllers),
           "predictive (default), proportional, minimum-of-n, quality (chooses the method, too) or fixed "
           "(none)")
      .needs({"--target-fps"});
  line.add("--min-scale", tools::number(options.min_scale, kScales, "S"),
           "Lowest scale that a controller may choose, per axis");
  line.add("--max-scale", tools::number(options.max_scale, kScales, "S"),
           "Highest scale that a controller may choose");
  line.add("--ladder", tools::choice(options.order, kOrders), "Order in which a controller changes the axes");
  line.add("--calibrate", tools::text(options.calibrate, "FILE"),
           "Instead: measure the cost of frames at some resolutions, for --calibration, and the error and "
           "cost of each method in this scene, for --controller quality")
      .writes()
      .excludes(
          {"--target-fps", "--out", "--contact-sheet", "--exr-frame", "--report", "--json", "--frames"});
  line.add("--truth-seconds", tools::number(options.truth_seconds, {.least = 0, .most = 3600}, "SECONDS"),
           "Longest time for truth then; if it takes longer, errors are against the best method")
      .needs({"--calibrate"});
  line.add("--calibration", tools::text(options.calibration, "FILE"), "File that --calibrate wrote")
      .needs({"--target-fps"})
      .counts_if(predicts, kPredicting);
  line.add("--follow-cpu", tools::call([&options] { options.cpu_bound = CpuBound::kFollow; }),
           "If the CPU takes longer than the target, its time becomes the target")
      .needs({"--target-fps"})
      .counts_if(predicts, kPredicting);
  line.add("--blur-aware", tools::flag(options.blur_aware),
           "Lower the highest resolution as the camera's motion blur gets longer")
      .needs({"--target-fps"})
      .counts_if(predicts, kPredicting);
  line.add("--detail-follows", tools::flag(options.detail_follows),
           "At low resolutions, leave out small surfaces and draw moving shadows less often")
      .needs({"--target-fps"});
  line.add("--buffers", tools::number(options.buffers, {.least = 2, .most = 8}), "Buffers of the display")
      .needs({"--target-fps"});
  line.add("--headroom", tools::number(options.headroom, {.least = 0, .most = 0.5}, "PART"),
           "Part of the refresh interval that a controller leaves free")
      .needs({"--target-fps"});
  line.add("--compare-fixed", tools::number(options.compared_scales, kScales, "S,S"),
           "Draw the same frames again at each of these fixed scales, beside those in the report")
      .needs({"--target-fps"});
  line.add("--frame-cost", tools::choice(options.cost, kCosts),
           "Cost of a frame: device (timers of OpenGL and OpenCL), span (until its picture is complete) or "
           "auto (default: device where both timers can be trusted)");
  line.check([&options](const tools::CommandLine& given) {
    if (!given.has("--blur")) given.refuse({"--blur-aware"}, "it needs --blur");
    check_together(given, options);
  });
}

constexpr const char* kExamples = R"(Examples:
  quincunx-render --out courtyard.png                    one frame of the default scene
  quincunx-render --scale-path sweep --frames 240 --out "out/frame.%04d.png" --report out/report
  quincunx-render --scene model.glb --scale 0.5 --frames 60 --out "orbit.%04d.exr"
  quincunx-render --scale 0.5 --frames 60 --score 4 --report out/report     beside truth
  quincunx-render --scene wheel --truth 8 --shutter 0.5 --out truth.exr     supersampled
  quincunx-render --target-fps 30 --frames 300 --report pace       a controller holds the rate
  quincunx-render --scene chart --scale 0.71 --explain             what this scene needs
  quincunx-render --window --scale 0.71                            in a window; H lists the keys
Exit status: 0 done, 1 failed, 2 wrong usage.)";

void add_run_options(tools::CommandLine& line, RenderOptions& options) {
  constexpr tools::Bounds kSamples = {.least = 1, .most = 64};
  line.group("Output");
  line.add("--out", tools::text(options.out, "PATTERN"),
           "Frames to write: .png, .jpg, .dpx (as displayed), .exr, .tif, .hdr (linear); #, @ or %04d in the "
           "name "
           "is the number")
      .common()
      .writes();
  line.add("--contact-sheet", tools::text(options.contact_sheet, "FILE"),
           "One picture that shows the whole run")
      .writes();
  line.add("--report", tools::text(options.report, "BASE"),
           "Write BASE.html, .txt and .json: passes, bytes, viewports, devices, scores")
      .common()
      .writes();
  line.add("--json", tools::flag(options.json), "Print the report as JSON on standard output");
  line.add("--score", tools::number(options.score, kSamples),
           "Score each frame against a truth of N x N samples a pixel; --report shows some beside it")
      .common();
  line.add("--explain", tools::flag(options.explain),
           "Print the plan: passes, buffers, what is left out; draw nothing")
      .common()
      .tells();
  line.add("--truth", tools::number(options.truth, kSamples),
           "Draw supersampled truth instead, at the output's size: N x N samples a pixel, averaged")
      .excludes({"Control",         "--method",    "--view",           "--sharpen",      "--blur",
                 "--jitter",        "--colour",    "--score",          "--report",       "--json",
                 "--contact-sheet", "--exr-frame", "--scale",          "--scale-path",   "--dual",
                 "--focus",         "--shading",   "--particle-scale", "--check-motion", "--no-overlap"},
                "truth has no use for it");
  line.add("--shutter", tools::number(options.shutter, tools::kPartOfOne, "PART"),
           "With --truth: part of the frame's time that the shutter is open")
      .needs({"--truth"});
  line.add("--exr-frame", tools::number(options.exr_frame, {.least = 0, .most = 1e15}),
           "Write this frame's targets and resolved picture as EXR beside --out")
      .needs({"--out"});
  line.add("--no-overlap", tools::flag(options.overlap, false),
           "Finish each frame before the next: cleaner pass times");
  line.add("--why", tools::text(options.why, "FILE"),
           "One picture instead: three places of the scene by bilinear, quincunx and temporal, at half the "
           "size "
           "or --scale, "
           "beside truth")
      .writes()
      .excludes({"Control", "Window", "Output", "--method", "--jitter", "--view", "--frames", "--scale-path",
                 "--dual", "--focus", "--colour", "--shading"},
                "this picture shows what it is for by itself");
  line.check([&options](const tools::CommandLine&) {
    for (const auto& [name, path] :
         {std::pair{"--contact-sheet", &options.contact_sheet}, {"--why", &options.why}}) {
      if (const std::string problem = path->empty() ? "" : tools::no_picture(*path); !problem.empty())
        throw tools::UsageError{name, problem};
    }
  });
}

void add_window_options(tools::CommandLine& line, RenderOptions& options) {
  line.group("Window");
  line.add("--window", tools::flag(options.window),
           "Show the frames in a window, until it is closed or --frames are shown")
      .common()
      .excludes({"--truth", "--score", "--out", "--contact-sheet", "--exr-frame", "--report", "--json",
                 "--calibrate", "--compare-fixed"},
                "keys of the window do such things");
  line.add("--script", tools::text(options.script, "FILE"),
           "Keys and sizes for the window, by frame; docs/programs.md")
      .needs({"--window"});
  line.add("--captures", tools::text(options.captures, "FOLDER"),
           "Folder of the window's screenshots and dumps (default: out)")
      .needs({"--window"})
      .writes();
  line.add("--hide-ui", tools::flag(options.show_ui, false),
           "Begin with the picture alone; Tab shows the panel")
      .needs({"--window"});
  line.add("--no-vsync", tools::flag(options.vsync, false), "Show pictures without waiting for the display")
      .needs({"--window"});
}

}  // namespace

LadderSettings ladder_for(const PacingOptions& options, Extent output) {
  return {.output_extent = output,
          .min_scale = options.min_scale,
          .max_scale = options.max_scale,
          .order = options.order};
}

Result<FramePacing> frame_pacing_for(const PacingOptions& options, Extent output, const ErrorFront& front) {
  if (!options.on()) return FramePacing::free_running(output);
  PacingSettings settings;
  settings.controller = options.controller;
  settings.ladder = ladder_for(options, output);
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

tools::CommandLine command_line(RenderOptions& options) {
  tools::CommandLine line(
      "Renders a scene at a dynamic resolution with OpenGL and makes the picture with OpenCL.",
      "quincunx-render", QUINCUNX_VERSION, kExamples);
  const auto method_is_settled = [&options] {
    return !options.window && options.why.empty() && !options.pacing.chooses_method();
  };
  add_picture_options(line, options, {.settled = method_is_settled});
  add_pacing_options(line, options.pacing);
  add_run_options(line, options);
  add_window_options(line, options);
  add_machine_options(line, options);
  return line;
}

std::optional<int> parse_command_line(int argc, char** argv, RenderOptions& options) {
  tools::CommandLine line = command_line(options);
  options.command_line = tools::command_line_text("quincunx-render", argc, argv);
  if (const std::optional<int> code = line.parse(argc, argv)) return code;
  // Held at its rate, the scene goes at its own speed.
  if (options.pacing.on() && !line.has("--fps")) options.fps = options.pacing.target_fps;
  // The targets hold whatever a controller may choose.
  if (options.pacing.has_ladder()) options.scale = fmt::format("{}", options.pacing.max_scale);
  if (!options.why.empty() && !line.has("--scale")) options.scale = "0.5";
  if (options.window && !line.has("--frames")) options.frames = 0;
  return std::nullopt;
}

}  // namespace quincunx::scenes
