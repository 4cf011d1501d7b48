// SPDX-License-Identifier: MIT
// The command line of quincunx-dump.
#include <fmt/format.h>

#include <map>
#include <tuple>
#include <utility>

#include "programs/dump_session.h"
#include "tools/program/command_line.h"

namespace quincunx::scenes {
namespace {

constexpr const char* kExamples = R"(Examples:
  quincunx-dump --out dump                               every stage of frame 0 of the default scene
  quincunx-dump --scene wheel --scale 0.5 --frame 12 --stages velocity,resolved,flip --out dump
  quincunx-dump --scene pan --scale 0.71 --frames 40 --sequence "pan/pan.%04d.exr" --truth 8
Files of a frame, in the folder of --out: frame.0012.render.exr (colour, Z, motion, reactive values,
as a sequence has them), .particles.exr, .history.exr, .target.exr, .tiles.exr, .output.exr
(resolved, blurred, presented, truth, errors), and one frame.0012.STAGE.png a stage.
Exit status: 0 done, 1 failed, 2 wrong usage.)";

void add_stage_options(tools::CommandLine& line, DumpOptions& options) {
  static const std::map<std::string, std::pair<bool, bool>> kFormats = {
      {"png", {true, false}}, {"exr", {false, true}}, {"both", {true, true}}};
  tools::Setting stages =
      tools::choice(tools::choices<Stage>(), [&options](Stage stage) { options.stages.push_back(stage); });
  stages.value = "NAME,NAME";
  stages.list = true;
  line.group("Output");
  line.add("--out", tools::text(options.out, "FOLDER"), "Folder for the stages of one frame")
      .common()
      .writes();
  line.add("--frame", tools::number(options.frame, {.least = 0, .most = 1e15}),
           "Frame of the run to show (default: 0)")
      .common();
  line.add("--stages", stages, "Stages to write (default: all that the run has)").common();
  line.add("--format",
           tools::choice(
               kFormats,
               [&options](const std::pair<bool, bool>& both) { std::tie(options.png, options.exr) = both; }),
           "png (for a person), exr (the numbers) or both (default)");
  line.add("--truth", tools::number(options.truth, {.least = 1, .most = 64}),
           "Supersampled truth, N x N samples a pixel (default: 8 where a stage needs it)")
      .common();
  line.add("--warm-up", tools::number(options.warm_up, {.least = 0, .most = 1e9}),
           fmt::format(
               "Frames resolved before that one, for its history (default: 1; {} of methods that accumulate)",
               kWarmUpFrames));
  line.add("--sequence", tools::text(options.sequence, "PATTERN"),
           "Instead: write the whole run in the exchange format, and its truth with --truth")
      .common()
      .writes()
      .excludes({"--out", "--frame", "--stages", "--format", "--warm-up"})
      .excludes(
          {"--view", "--sharpen", "--blur", "--velocity-weight", "--residual-weight", "--no-clamp-ringing",
           "--grain", "--still-noise", "--check-motion", "--sky-motion", "--no-dither"},
          "its frames are not resolved")
      .excludes({"--particle-scale", "--focus"}, "it holds whole frames of one view");
  line.add("--device-depth", tools::flag(options.device_depth),
           "With --sequence: Z is near / distance as drawn, not distance")
      .needs({"--sequence"});
  line.add(
          "--dilate-velocity", tools::flag(options.dilate_velocity),
          "With --sequence: each pixel has the motion of the nearest of its 3x3, as other renderers write it")
      .needs({"--sequence"});
  line.check([&options](const tools::CommandLine& given) {
    if (!options.list_scenes && !options.list_devices && options.out.empty() && options.sequence.empty())
      throw tools::UsageError{"--out",
                              "it is missing: give the folder for the stages, or --sequence PATTERN"};
    if (!options.sequence.empty() && options.resolve.targets.shading == Shading::kCheckerboard)
      given.refuse({"--sequence"}, "it holds whole frames; give it without --shading checkerboard");
    if (options.focus == kFocusPointer)
      given.refuse({"--focus"}, "pointer is for a window; give an object or a rectangle");
    if (!given.has("--warm-up") && options.resolve.method == Method::kTemporal)
      options.warm_up = kWarmUpFrames;
  });
}

}  // namespace

tools::CommandLine command_line(DumpOptions& options) {
  tools::CommandLine line("Shows what happens inside a frame: every stage, or a run as a sequence.",
                          "quincunx-dump", QUINCUNX_VERSION, kExamples);
  add_picture_options(line, options);
  add_stage_options(line, options);
  add_machine_options(line, options);
  return line;
}

}  // namespace quincunx::scenes
