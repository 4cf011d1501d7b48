// SPDX-License-Identifier: MIT
#include "bench/bench_options.h"

#include <fmt/format.h>

#include "tools/program/command_line.h"
#include "tools/program/program.h"

namespace quincunx::bench {

using namespace tools;

namespace {

constexpr const char* kExamples = R"(Examples:
  quincunx-bench --out report                          everything; open report/bench.html
  quincunx-bench --quick --out report                  small pictures of three scenes: two minutes
  quincunx-bench --scenes wires,pan --scales 0.5,0.71 --methods bilinear,quincunx --json
  quincunx-bench --quick --compare old/bench.json      what got better or worse beyond noise
  quincunx-bench --from new/bench.json --compare old/bench.json      the same, of two files
  quincunx-bench --traces --out report                 controllers; open report/traces.html
  quincunx-bench --resize --scenes pan                 cost of another resolution
  quincunx-bench --parts --scenes courtyard            scales of picture, shadow map and particles
  quincunx-bench --tune                                best shape of each pass, used from then on
  quincunx-bench --front front.json                    errors and costs for --controller quality
Exit status: 0 done, 1 failed or something got worse (--compare), 2 wrong usage.)";

void add_choice_options(CommandLine& line, BenchOptions& options) {
  line.group("Measured");
  line.add("--scenes", text(options.scenes, "NAME,..."),
           "Built-in scenes or .gltf and .glb files (default: all built in)")
      .common();
  line.add("--scales", number(options.scales, {}, "S,..."), "Render scales").common();
  line.add("--methods", text(options.methods, "NAME,..."),
           "Methods (default: all of --list-methods); before or behind NAME: @rgba8 (8-bit colour), "
           "checkerboard/ (half of the pixels shaded), dual0.8/ (an output of 0.8 that is then scaled), "
           "two-way/ (both ways), denoised/ (with --noise), "
           "focus/ (with --focus)")
      .common();
  line.add("--list-methods", flag(options.list_methods), "List the methods").tells();
  line.add("--list-scenes", flag(options.list_scenes), "List the built-in scenes and their purpose").tells();
  line.add("--output", extent(options.output), "Size of the picture").common();
  line.add("--quick", flag(options.quick),
           "In two minutes: --output 320x180 --scenes courtyard,wires,occluders --scales 0.5,0.71,1 --frames "
           "4 --rounds 4 --truth 4, each unless given")
      .common();
  line.add("--frames", number(options.frames, {.least = 1, .most = 10000}),
           "Frames whose errors are measured, and of each timed round")
      .common();
  line.add("--warm-up", number(options.warm_up, {.least = 1, .most = 1000}),
           "Frames before those that are measured, and before the first timed round");
  line.add("--history-warm-up", number(options.history_warm_up, {.least = 1, .most = 10000}),
           "Likewise before the measured ones, of methods that accumulate; never fewer than --warm-up");
  line.add("--rounds", number(options.rounds, {.least = 1, .most = 10000}), "Rounds that are timed").common();
  line.add("--truth", number(options.truth, {.least = 1, .most = 64}), "Truth has N x N samples a pixel");
  line.add("--noise", number(options.noise, {.least = 1, .most = 64}, "SPP"),
           "Frames as noisy as a path tracer's with so many samples a pixel (default: no noise)");
  line.add(
      "--focus", text(options.focus, "OBJECT|X,Y,W,H"),
      "Also measure errors inside and outside of this part of the picture; methods focus/NAME draw it again");
  line.add("--focus-scale", number(options.focus_scale, {.least = 0.02, .most = 2}, "S"),
           "Render scale of that part")
      .needs({"--focus"});
  line.add("--fps", number(options.fps, {.least = 0, .most = 1e6, .beyond = true}),
           "Frames a second of scene time");
  line.add("--start", number(options.start, {.least = -1e6, .most = 1e6}, "SECONDS"),
           "Scene time of the first frame");
  line.add("--seed", number(options.seed), "Seed of random parts of scenes; same seed, same pixels");
}

void add_result_options(CommandLine& line, BenchOptions& options) {
  line.group("Output");
  line.add("--out", text(options.out, "FOLDER"),
           "Write .json, .csv and, but for --resize, --parts and --tune, a page into this folder")
      .common()
      .writes();
  line.add("--json", flag(options.json), "Print the results as JSON on standard output");
  line.add("--compare", text(options.compare, "OLD.json"),
           "Say what got better or worse since this bench.json")
      .common();
  line.add("--from", text(options.from, "NEW.json"), "Measure nothing: compare this bench.json")
      .needs({"--compare"})
      .excludes({"Measured"}, "nothing is measured");
}

// What is measured instead; at most one of these.
void add_modes(CommandLine& line, BenchOptions& options) {
  line.group("Instead");
  line.add("--traces", flag(options.traces.wanted),
           "Resolution controllers over load traces, on a simulated display")
      .common()
      .excludes({"Measured", "--compare", "--from"}, "traces are simulated");
  line.add("--resize", flag(options.resize.wanted),
           "Cost of another resolution, and frames with viewport and with placed targets")
      .excludes({"--traces", "--compare", "--from"}, "each is a measurement of its own");
  line.add("--parts", flag(options.parts_bench.wanted),
           "Cost and error of the scales of the picture, the shadow map and the particles")
      .excludes({"--traces", "--resize", "--compare", "--from"}, "each is a measurement of its own");
  line.add("--tune", flag(options.tune.wanted),
           "Find the best shape of each pass on this device; used from then on")
      .common()
      .excludes({"--traces", "--resize", "--parts", "--compare", "--from"},
                "each is a measurement of its own");
  line.add("--front", text(options.front.file, "FILE"),
           "Error and cost by class of scenes, method and scale; into FILE and the cache folder, for a "
           "controller that chooses the method")
      .writes()
      .excludes({"--traces", "--resize", "--parts", "--tune", "--compare", "--from", "--scenes", "--out"},
                "it has scenes and files of its own");
  line.add("--resizes", number(options.resize.resizes, {.least = 1, .most = 1000000}),
           "Resizes that are timed")
      .needs({"--resize"});
  line.add("--base-scale", number(options.parts_bench.base_scale, {.least = 0.02, .most = 2}, "S"),
           "The picture's scale where a part's is changed")
      .needs({"--parts"});
  line.add("--tune-frames", number(options.tune.frames, {.least = 1, .most = 10000}),
           "Timed frames of each shape")
      .needs({"--tune"});
  line.add("--tune-cases", text(options.tune.cases, "NAME,..."),
           "Only point, bilinear, lanczos2, noise, noise-offset, quincunx, reprojected, camera, temporal or "
           "checkerboard; passes that none of them runs share one shape")
      .needs({"--tune"});
  traces::TraceOptions& traces = options.traces;
  line.group("Traces");
  line.add("--hz", number(traces.refresh_hz, {.least = 1, .most = 1000}, "HZ,..."), "Refresh rates")
      .needs({"--traces"});
  line.add("--buffers", number(traces.buffers, {.least = 2, .most = 8}, "N,..."), "Buffers of the swap chain")
      .needs({"--traces"});
  line.add("--latency", number(traces.latencies, {.least = 1, .most = 8}, "N,..."),
           "Frames until a timer comes back")
      .needs({"--traces"});
  line.add("--every-display", flag(traces.every_display),
           "30, 60, 120 Hz; 2 and 3 buffers; timers 1 to 4 frames late")
      .needs({"--traces"})
      .excludes({"--hz", "--buffers", "--latency"}, "it takes all of them");
  line.add("--seeds", number(traces.seeds, {}, "N,..."), "Seeds of the scripted loads").needs({"--traces"});
  line.add("--recorded", text(traces.recorded, "FILE,..."),
           "Also replay these CSV files (columns gpu_ms, area_fraction, cpu_ms)")
      .needs({"--traces"});
  line.add("--recorded-target-ms",
           number(traces.recording.target_ms, {.least = 0, .most = 1e6, .beyond = true}, "MS"),
           "Target that recorded times are measured in")
      .needs({"--recorded"});
  line.add("--recorded-fixed-part", number(traces.recording.fixed_part, kPartOfOne, "PART"),
           "Part of recorded costs that does not scale")
      .needs({"--recorded"});
  line.add("--quality", flag(traces.quality),
           "Compare the quality controller with predictive, by scripted pictures and times of passes")
      .needs({"--traces"})
      .excludes({"--recorded", "--every-display"});
  line.add("--budgets", number(traces.budgets, {.least = 0.1, .most = 10}, "B,..."),
           "Multiples of the time that frames are written for")
      .needs({"--quality"});
  line.add("--untimed", flag(traces.untimed), "Give the controllers no times of passes").needs({"--quality"});
}

void apply_quick(const CommandLine& app, BenchOptions& options) {
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

CommandLine command_line(BenchOptions& options) {
  CommandLine line(
      "Speed against error: every method at every scale of every scene, against supersampled truth.",
      "quincunx-bench", QUINCUNX_VERSION, kExamples);
  options.frames = 6;
  add_choice_options(line, options);
  add_result_options(line, options);
  add_modes(line, options);
  scenes::add_machine_options(line, options);
  return line;
}

std::optional<int> parse_command_line(int argc, char** argv, BenchOptions& options) {
  CommandLine line = command_line(options);
  options.command_line = tools::command_line_text("quincunx-bench", argc, argv);
  if (const std::optional<int> code = line.parse(argc, argv)) return code;
  apply_quick(line, options);
  if (options.resize.wanted && !line.has("--scales")) options.scales = {0.5, 0.7, 1};
  if (options.parts_bench.wanted && !line.has("--scales")) options.scales = {0.35, 0.5, 0.6, 0.85, 1};
  if (!options.front.file.empty()) apply_front_defaults(line, options);
  return std::nullopt;
}

}  // namespace quincunx::bench
