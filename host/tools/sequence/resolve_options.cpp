// SPDX-License-Identifier: MIT
#include "tools/sequence/resolve_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <thread>
#include <utility>

#include "tools/program/command_line.h"
#include "tools/program/program.h"
#include "tools/program/resolve_settings_options.h"
#include "tools/sequence/channel_options.h"
#include "tools/sequence/frame_numbers.h"

namespace quincunx::tools {
namespace {

constexpr const char* kExamples = R"(Examples:
  quincunx-resolve "seq/frame.%04d.exr" --out "up/up.%04d.exr"               the exchange format says the rest
  quincunx-resolve "shot/shot.####.exr" --out "up/up.####.exr" --output 3840x2160 --colour ViewLayer.Combined \
      --velocity ViewLayer.Vector.X,ViewLayer.Vector.Y --velocity-convention blender --depth ViewLayer.Depth.Z
  quincunx-resolve "seq/frame.%04d.exr" --out "up/up.%04d.exr" --output 640x360 --velocity motion.X,motion.Y \
      --velocity-convention fsr2 --truth "truth/truth.%04d.exr"              with scores of each frame
  quincunx-resolve "seq/frame.%04d.exr" --out "up/up.%04d.exr" --frames 101-200   one chunk of a render farm
  quincunx-resolve "seq/frame.%04d.exr" --out "up/up.%04d.exr" -n            only say what would be done
Exit status: 0 done, 1 failed, 2 wrong usage.)";

UsageError wrong(const std::string& option, const std::string& reason) {
  return UsageError{option, reason};
}

void add_picture_options(CommandLine& app, ResolveOptions& options) {
  static const std::map<std::string, ChannelType> kTypes = {{"half", ChannelType::kHalf},
                                                            {"float", ChannelType::kFloat}};
  app.add_option("INPUT", options.input, "Frames to read: #, @ or %04d is the number").type_name("PATTERN");
  app.add_option("--out", options.out,
                 "Frames to write: .exr (linear) or .png (presented); #, @ or %04d is the number")
      .type_name("PATTERN");
  app.add_option_function<std::string>(
         "--output",
         [&options](const std::string& text) {
           Extent extent;
           const std::string error = parse_extent(text, extent);
           if (!error.empty()) throw wrong("--output", error);
           options.sequence.output = extent;
         },
         "Size of the picture (default: attribute quincunx:outputSize)")
      .type_name("WxH");
  add_resolve_options(app, options.resolve, "what the frames offer decides");
  app.add_option("--exposure", options.exposure, "Multiplies linear colour in a PNG (default: 1)").positive();
  add_choice(app, "--store", options.stored, kTypes, "half (default) or float in an EXR");
  app.add_option("--truth", options.truth, "True pictures to score the frames against, where there are any")
      .type_name("PATTERN");
  app.add_option("--truth-colour,--truth-color", options.truth_colour,
                 "Layer of the true pictures (default: without layer)")
      .type_name("LAYER")
      .needs("--truth");
}

void add_run_options(CommandLine& app, ResolveOptions& options) {
  app.add_option_function<std::string>(
         "--frames",
         [&options](const std::string& text) {
           auto frames = parse_frame_numbers(text);
           if (!frames.ok()) throw wrong("--frames", frames.status().message());
           options.frames = std::move(frames).value();
         },
         "Frames to write, for example 1-10x2,20 (default: all there are)")
      .type_name("RANGES");
  app.add_option_function<int>(
         "--warm-up", [&options](int count) { options.warm_up = count; },
         "Frames to read before the first, for its history (default: as many as the method looks back)")
      .in_range(0, 100000)
      .type_name("N");
  app.add_flag("--resume", options.resume, "Leave frames out that are there already");
  app.add_flag("--skip-bad-frames", options.skip_bad_frames, "Go on without frames that cannot be used");
  app.add_flag("-n,--dry-run", options.dry_run, "Only list what would be read and made, and what is missing");
  app.add_flag("--explain", options.explain, "Only print the plan: passes, buffers, what is left out");
  app.add_option("--threads", options.threads,
                 "Threads that read and write files (default: as many as there are processors)")
      .in_range(1, 256);
  app.add_option("--device", options.device,
                 "OpenCL device: cpu, gpu, a number of --list-devices or part of a name");
  app.add_flag("--list-devices", options.list_devices, "List the OpenCL devices");
  app.add_option("--report", options.report, "Write BASE.html, .txt and .json: scores, times, passes")
      .type_name("BASE");
  app.add_flag("--json", options.json, "Print the report as JSON on standard output");
  app.add_flag("-q,--quiet", options.quiet, "Say nothing but errors");
  app.add_flag("-v,--verbose", options.verbosity, "Say more; twice: everything");
}

// What options alone cannot express.
void check_needs(const ResolveOptions& options) {
  if (options.list_devices) return;
  if (options.input.empty()) throw wrong("INPUT", "is missing: give the pattern of the frames to read");
  const bool writes_nothing = options.dry_run || options.explain || !options.truth.empty();
  if (options.out.empty() && !writes_nothing)
    throw wrong("--out", "is missing: give the pattern of the frames to write");
  if (options.resume && options.out.empty()) throw wrong("--resume", "needs --out");
}

}  // namespace

std::optional<int> parse_command_line(int argc, char** argv, ResolveOptions& options) {
  CommandLine app(
      "Makes full-size frames from an EXR sequence of any renderer, with OpenCL and without OpenGL.",
      "quincunx-resolve", QUINCUNX_VERSION, kExamples);
  options.threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 256u));
  add_picture_options(app, options);
  add_channel_options(app, options);
  add_run_options(app, options);
  options.command_line = command_line_text("quincunx-resolve", argc, argv);
  return app.parse(argc, argv, [&app, &options] {
    options.method_named = app.has("--method");
    check_needs(options);
  });
}

}  // namespace quincunx::tools
