// SPDX-License-Identifier: MIT
#include "programs/render_options.h"

#include <fmt/format.h>

#include "tools/program/command_line.h"
#include "tools/program/program.h"

namespace quincunx::scenes {
namespace {

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

void add_window_options(tools::CommandLine& app, RenderOptions& options) {
  const auto window = app.add_flag("--window", options.window,
                                   "Show the frames in a window, until it is closed or --frames are shown");
  for (const char* other : {"--truth", "--score", "--out", "--contact-sheet", "--exr-frame", "--report",
                            "--json", "--calibrate", "--compare-fixed"}) {
    window.excludes(app.option(other));
  }
  app.add_option("--script", options.script, "Keys and sizes for the window, by frame; docs/window.md")
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

std::optional<int> parse_command_line(int argc, char** argv, RenderOptions& options) {
  tools::CommandLine app(
      "Renders a scene at a dynamic resolution with OpenGL and makes the picture from it with OpenCL.",
      "quincunx-render", QUINCUNX_VERSION, kExamples);
  add_picture_options(app, options);
  add_pacing_options(app, options.pacing);
  add_run_options(app, options);
  add_window_options(app, options);
  add_machine_options(app, options);
  options.command_line = tools::command_line_text("quincunx-render", argc, argv);
  if (const std::optional<int> code = app.parse(argc, argv)) return code;
  // Held at its rate, the scene goes at its own speed.
  if (options.pacing.on() && !app.has("--fps")) options.fps = options.pacing.target_fps;
  // The targets hold whatever a controller may choose.
  if (options.pacing.has_ladder()) options.scale = fmt::format("{}", options.pacing.max_scale);
  if (options.window && !app.has("--frames")) options.frames = 0;
  return std::nullopt;
}

}  // namespace quincunx::scenes
