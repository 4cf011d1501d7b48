// SPDX-License-Identifier: MIT
#include "bench/bench_options.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/program/command_line.h"
#include "tools/program/program.h"

namespace quincunx::bench {
namespace {

constexpr const char* kExamples = R"(Examples:
  quincunx-bench --out report                        everything: all scenes, scales and methods; open report/bench.html
  quincunx-bench --quick --out report                small pictures of three scenes: under two minutes
  quincunx-bench --scenes wires,pan --scales 0.5,0.71 --methods bilinear,quincunx --json
  quincunx-bench --quick --compare old/bench.json    what got better or worse beyond noise
  quincunx-bench --from new/bench.json --compare old/bench.json       the same of two files, nothing is measured
  quincunx-bench --traces --out report               resolution controllers over load traces; open report/traces.html
  quincunx-bench --resize --scenes pan               another resolution: its cost, viewport and placed targets
  quincunx-bench --parts --scenes courtyard           scales of the picture, the shadow map and particles
  quincunx-bench --tune                              how each pass is best cut on this device; used from then on
  quincunx-bench --front front.json                  what each method errs and costs here, by class of scenes and scale
Exit status: 0 done, 1 failed or something got worse (--compare), 2 wrong usage.)";

void add_choice_options(tools::CommandLine& app, BenchOptions& options) {
  app.add_option("--scenes", options.scenes,
                 "Built-in scenes or .gltf and .glb files (default: all built in)")
      .delimiter(',')
      .type_name("NAME,...");
  app.add_option("--scales", options.scales, "Render scales (default: 0.35,0.5,0.71,0.85,1)")
      .delimiter(',')
      .type_name("S,...");
  app.add_option(
         "--methods", options.methods,
         "Methods (default: all of --list-methods); NAME@rgba8 is NAME on 8-bit colour, checkerboard/NAME "
         "of frames with half of their pixels shaded, dual0.8/NAME at an output of 0.8 that is then scaled, "
         "two-way/NAME both ways, denoised/NAME with --noise, focus/NAME with --focus")
      .delimiter(',')
      .type_name("NAME,...");
  app.add_option(
         "--focus", options.focus,
         "Tell errors in this part of the picture and outside of it apart; methods focus/NAME draw it again")
      .type_name("OBJECT|X,Y,W,H");
  app.add_option("--focus-scale", options.focus_scale, "Render scale of that part")
      .in_range(0.02, 2.0)
      .show_default();
  app.add_flag("--list-methods", options.list_methods, "List the methods");
  app.add_option_function<std::string>(
         "--output",
         [&options](const std::string& text) {
           const std::string error = tools::parse_extent(text, options.output);
           if (!error.empty()) throw tools::UsageError{"--output", error};
         },
         "Size of the picture (default: 1280x720)")
      .type_name("WxH");
  app.add_option("--seed", options.seed, "Of what is random in a scene; same seed, same pixels")
      .show_default();
  app.add_flag(
      "--quick", options.quick,
      "For a look in under two minutes: --output 320x180 --scenes courtyard,wires,occluders --scales "
      "0.5,0.71,1 --frames 4 --rounds 4 --truth 4, each unless given");
}

void add_measuring_options(tools::CommandLine& app, BenchOptions& options) {
  app.add_option("--frames", options.frames,
                 "Frames whose errors are measured, and of each timed round (default: 6)")
      .in_range(1, 10000);
  app.add_option("--warm-up", options.warm_up,
                 "Frames that do not count, before those that are measured and before the first timed round "
                 "(default: 2)")
      .in_range(1, 1000);
  app.add_option("--history-warm-up", options.history_warm_up,
                 "Of methods that accumulate, frames before those that are measured (default: 24; never "
                 "fewer than --warm-up)")
      .in_range(1, 10000);
  app.add_option("--rounds", options.rounds, "Rounds that are timed, after those (default: 5)")
      .in_range(1, 10000);
  app.add_option("--truth", options.truth, "Truth has N x N samples a pixel (default: 8)")
      .in_range(1, 64)
      .type_name("N");
  app.add_option("--noise", options.noise,
                 "Frames are as noisy as those of a path tracer with so many samples a pixel; methods "
                 "denoised/NAME know of it (default: no noise)")
      .in_range(1, 64)
      .type_name("SPP");
  app.add_option("--fps", options.fps, "Frames a second of scene time").positive().show_default();
  app.add_option("--start", options.start, "Scene time of the first frame, seconds").show_default();
}

void add_result_options(tools::CommandLine& app, BenchOptions& options) {
  app.add_option("--out", options.out,
                 "Write bench.json, .csv, .svg and .html (with --traces: traces.json, .csv and .html; with "
                 "--resize: resize.json and .csv; with --parts: parts.json and .csv; with --tune: tune.json "
                 "and .csv) into this folder")
      .type_name("FOLDER");
  const auto compare =
      app.add_option("--compare", options.compare, "Say what got better or worse since this bench.json")
          .type_name("OLD.json");
  app.add_option("--from", options.from, "Measure nothing: compare this bench.json")
      .type_name("NEW.json")
      .needs(compare);
  app.add_flag("--json", options.json, "Print the results as JSON on standard output");
}

void apply_quick(const tools::CommandLine& app, BenchOptions& options) {
  if (!options.quick) return;
  const auto unless_given = [&app](const char* option, auto& value, auto quick) {
    if (!app.has(option)) value = quick;
  };
  unless_given("--output", options.output, Extent{320, 180});
  unless_given("--scenes", options.scenes, std::vector<std::string>{"courtyard", "wires", "occluders"});
  unless_given("--scales", options.scales, std::vector<double>{0.5, 0.71, 1});
  unless_given("--frames", options.frames, 4);
  unless_given("--rounds", options.rounds, 4);
  unless_given("--truth", options.truth, 4);
}

}  // namespace

std::optional<int> parse_command_line(int argc, char** argv, BenchOptions& options) {
  tools::CommandLine app(
      "Speed against error: every method at every scale of every scene, against supersampled truth.",
      "quincunx-bench", QUINCUNX_VERSION, kExamples);
  options.frames = 6;
  add_choice_options(app, options);
  add_measuring_options(app, options);
  add_result_options(app, options);
  traces::add_trace_options(app, options.traces);
  add_resize_options(app, options.resize);
  add_parts_options(app, options.parts_bench);
  add_tune_options(app, options.tune);
  add_front_options(app, options.front);
  scenes::add_machine_options(app, options);
  options.command_line = tools::command_line_text("quincunx-bench", argc, argv);
  if (const std::optional<int> code = app.parse(argc, argv)) return code;
  apply_quick(app, options);
  if (options.resize.wanted && !app.has("--scales")) options.scales = {0.5, 0.7, 1};
  if (options.parts_bench.wanted && !app.has("--scales")) options.scales = {0.35, 0.5, 0.6, 0.85, 1};
  if (!options.front.file.empty()) apply_front_defaults(app, options);
  return std::nullopt;
}

}  // namespace quincunx::bench
