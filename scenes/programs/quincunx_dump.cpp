// SPDX-License-Identifier: MIT
// quincunx-dump: every stage of a frame as numbers and as pictures, or a run as a sequence.
#include <fmt/format.h>

#include "programs/dump_session.h"
#include "tools/program/command_line.h"
#include "tools/program/program.h"

namespace quincunx::scenes {
namespace {

constexpr const char* kExamples = R"(Examples:
  quincunx-dump --out dump                                     every stage of frame 0 of the default scene
  quincunx-dump --scene wheel --scale 0.5 --frame 12 --stages velocity,resolved,flip --out dump
  quincunx-dump --scene pan --scale 0.71 --frames 40 --sequence "pan/pan.%04d.exr" --truth 8
Files of a frame, in the folder of --out: frame.0012.render.exr (colour, Z, motion, reactive values, as a sequence
has them), .particles.exr, .history.exr, .target.exr, .tiles.exr, .output.exr (resolved, blurred, presented, truth, errors), and
one frame.0012.STAGE.png a stage.
Exit status: 0 done, 1 failed, 2 wrong usage.)";

void add_stage_options(tools::CommandLine& app, DumpOptions& options) {
  const auto frame =
      app.add_option("--frame", options.frame, "Which frame of the run").non_negative().type_name("N");
  app.add_option_function<std::vector<std::string>>(
         "--stages",
         [&options](const std::vector<std::string>& names) {
           for (const std::string& name : names) {
             const auto stage = stage_named(name);
             if (!stage) {
               throw tools::UsageError{"--stages", fmt::format("'{}' is none of {}", name, stage_names())};
             }
             options.stages.push_back(*stage);
           }
         },
         "Which stages: " + stage_names() + " (default: all there are)")
      .delimiter(',')
      .type_name("NAME,NAME");
  const auto out =
      app.add_option("--out", options.out, "Folder for the stages of one frame").type_name("FOLDER");
  app.add_option_function<std::string>(
         "--format",
         [&options](const std::string& format) {
           if (format != "png" && format != "exr" && format != "both") {
             throw tools::UsageError{"--format", fmt::format("'{}' is none of png, exr, both", format)};
           }
           options.png = format != "exr";
           options.exr = format != "png";
         },
         "png (for a person), exr (the numbers) or both (default)")
      .type_name("NAME");
  app.add_option("--truth", options.truth,
                 "Supersampled truth, N x N samples a pixel (default: 8 where a stage needs it)")
      .in_range(1, 64)
      .type_name("N");
  app.add_option(
         "--warm-up", options.warm_up,
         fmt::format("Frames resolved before the one that is shown, for its history (default: 1; {} of "
                     "methods that accumulate)",
                     kWarmUpFrames))
      .non_negative();
  const auto sequence =
      app.add_option("--sequence", options.sequence,
                     "Instead: write the whole run in the exchange format, and its truth with --truth")
          .type_name("PATTERN")
          .excludes(out)
          .excludes(frame);
  app.add_flag("--device-depth", options.device_depth,
               "With --sequence: Z is near / distance as drawn, not distance")
      .needs(sequence);
  app.add_flag(
         "--dilate-velocity", options.dilate_velocity,
         "With --sequence: each pixel has the motion of the nearest of its 3x3, as other renderers write it")
      .needs(sequence);
}

// Reads a command line. On --help, --version or a usage error it prints and gives the exit code (0 or 2) instead.
std::optional<int> parse_command_line(int argc, char** argv, DumpOptions& options) {
  tools::CommandLine app(
      "Shows what happens inside a frame: every stage as numbers and as a picture, or a run as a sequence.",
      "quincunx-dump", QUINCUNX_VERSION, kExamples);
  add_stage_options(app, options);
  add_picture_options(app, options);
  add_machine_options(app, options);
  const auto check_needs = [&options] {
    const bool listing = options.list_scenes || options.list_devices;
    if (!listing && options.out.empty() && options.sequence.empty()) {
      throw tools::UsageError{"--out", "is missing: give the folder for the stages, or --sequence PATTERN"};
    }
    if (!options.sequence.empty() && options.resolve.targets.shading == Shading::kCheckerboard)
      throw tools::UsageError{"--sequence", "holds whole frames; give it without --shading checkerboard"};
    if (!options.sequence.empty() && options.parts.particles)
      throw tools::UsageError{"--sequence", "holds whole frames; give it without --particle-scale"};
    if (!options.sequence.empty() && !options.focus.empty())
      throw tools::UsageError{"--sequence", "holds one view of each frame; give it without --focus"};
    if (options.focus == kFocusPointer)
      throw tools::UsageError{"--focus", "pointer is for a window; give an object or a rectangle"};
  };
  if (const std::optional<int> code = app.parse(argc, argv, check_needs)) return code;
  if (!app.has("--warm-up") && options.resolve.method == Method::kTemporal) options.warm_up = kWarmUpFrames;
  return std::nullopt;
}

int dump_stages(const DumpOptions& options) {
  auto session = DumpSession::create(options);
  if (!session.ok()) return tools::fail(session.status());
  if (Status status = session.value()->run(); !status.ok()) return tools::fail(status);
  if (!options.quiet) {
    for (const std::string& file : session.value()->files())
      fmt::print("{}\n", file);
  }
  return tools::kDone;
}

int run(int argc, char** argv) {
  DumpOptions options;
  if (const auto exit_code = parse_command_line(argc, argv, options)) return *exit_code;
  tools::set_up_log(options.quiet, options.verbosity);
  if (options.list_scenes) {
    print_scenes();
  } else if (options.list_devices) {
    print_devices(options);
  } else if (!options.sequence.empty()) {
    const Status status = dump_sequence(options);
    return status.ok() ? tools::kDone : tools::fail(status);
  } else {
    return dump_stages(options);
  }
  return tools::kDone;
}

}  // namespace
}  // namespace quincunx::scenes

int main(int argc, char** argv) {
  return quincunx::tools::run_program("quincunx-dump", quincunx::scenes::run, argc, argv);
}
