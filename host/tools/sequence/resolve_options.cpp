// SPDX-License-Identifier: MIT
// The command line of quincunx-resolve.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "tools/program/command_line.h"
#include "tools/program/frame_pattern.h"
#include "tools/program/program.h"
#include "tools/program/resolve_settings_options.h"
#include "tools/sequence/resolve_task.h"

namespace quincunx::tools {
namespace {

// Reads "2.5GB".
std::uint64_t parse_bytes(const std::string& option, const std::string& text) {
  const double unit = text.ends_with("GB") ? 1e9 : text.ends_with("MB") ? 1e6 : 0;
  const double count = unit > 0 ? number_in(text.substr(0, text.size() - 2)).value_or(NAN) : NAN;
  if (!(count >= 0 && count * unit < 1e18))
    throw UsageError{option, fmt::format("'{}' is no size; write for example 2GB or 500MB", text)};
  return static_cast<std::uint64_t>(count * unit);
}

// The channels that are read, and what they mean.

// "A,B" into two words that are not empty.
std::vector<std::string> split_pair(const std::string& option, const std::string& text,
                                    const std::string& example) {
  const std::size_t comma = text.find(',');
  const bool good = comma != std::string::npos && comma > 0 && comma + 1 < text.size() &&
                    text.find(',', comma + 1) == std::string::npos;
  if (!good) throw UsageError{option, fmt::format("'{}' is not two with a comma between; {}", text, example)};
  return {text.substr(0, comma), text.substr(comma + 1)};
}

float parse_float(const std::string& option, const std::string& text) {
  const float value = static_cast<float>(number_in(text).value_or(NAN));
  if (!std::isfinite(value)) throw UsageError{option, fmt::format("'{}' is no number", text)};
  return value;
}

void set_velocity(SequenceInput& input, const std::string& text) {
  if (text == "none" || text == "camera") {
    input.motion = text == "none" ? MotionSource::kNone : MotionSource::kCamera;
    return;
  }
  input.motion = MotionSource::kChannels;
  input.velocity = split_pair("--velocity", text, "write U,V, or none, or camera");
}

void add_motion_options(CommandLine& app, ResolveOptions& options) {
  SequenceInput& input = options.sequence;
  static const std::map<std::string, VelocityConvention> kConventions = {
      {"nuke", VelocityConvention::kNuke},
      {"blender", VelocityConvention::kBlender},
      {"fsr2", VelocityConvention::kFsr2},
      {"ndc", VelocityConvention::kNdc}};
  app.add_option_function<std::string>(
         "--velocity", [&input](const std::string& text) { set_velocity(input, text); },
         "Motion's channels; camera: from depth and worldToNDC; none (default: backward.u,backward.v, if "
         "any)")
      .type_name("U,V");
  app.add_option_function<std::string>(
         "--velocity-next",
         [&input](const std::string& text) {
           input.next_velocity = split_pair("--velocity-next", text, "write U,V");
         },
         "Channels of the motion from each frame to the next, for --two-way, in the same sense: earlier - "
         "later where --velocity has previous - current (default: forward.u,forward.v, if any)")
      .type_name("U,V");
  add_choice(
      app, "--velocity-convention", kConventions,
      "What motion means: nuke and blender (previous - current, pixels, up), fsr2 (the same, down), ndc "
      "(current - previous, -1 to 1, up)",
      [&input](VelocityConvention convention) {
        input.units = VelocityUnits{convention, {1, 1}};
      });
  app.add_option_function<std::string>(
         "--velocity-scale",
         [&input](const std::string& text) {
           const auto parts = split_pair("--velocity-scale", text, "write for example -0.5,0.5");
           input.units = VelocityUnits{
               VelocityConvention::kScale,
               {parse_float("--velocity-scale", parts[0]), parse_float("--velocity-scale", parts[1])}};
         },
         "Or: what makes motion current - previous in parts of the image, y down")
      .type_name("X,Y")
      .excludes("--velocity-convention");
  app.add_flag("--velocity-jittered", input.velocity_jittered, "The jitter is in the motion");
  add_choice(app, "--drawn-velocity", options.resolve.conventions.drawn_velocity, choices<DrawnVelocity>(),
             "Whose motion a pixel has: its own surface's, or dilated, that of the nearest of its 3x3 "
             "(default: own)");
}

void add_channel_options(CommandLine& app, ResolveOptions& options) {
  SequenceInput& input = options.sequence;
  static const std::map<std::string, DepthKind> kDepthKinds = {
      {"linear", DepthKind::kLinear},
      {"device", DepthKind::kDevice},
      {"device-reversed", DepthKind::kDeviceReversed}};
  const auto channel = [](std::optional<std::string>& target) {
    return [&target](const std::string& name) { target = name == "none" ? "" : name; };
  };
  app.add_option("--colour,--color", input.colour_layer,
                 "Layer of colour: R, G, B, A of LAYER (default: without layer)")
      .type_name("LAYER");
  add_motion_options(app, options);
  app.add_option_function<std::string>("--depth", channel(input.depth),
                                       "Depth's channel, or none (default: Z, if any)")
      .type_name("CHANNEL");
  add_choice(app, "--depth-kind", input.depth_kind, kDepthKinds,
             "linear (distance along the view axis), device (far is 1) or device-reversed (far is 0)");
  app.add_option_function<float>(
         "--near", [&input](float distance) { input.near_plane = distance; },
         "Near plane's distance, of linear depth (default: attribute quincunx:near)")
      .positive()
      .type_name("D");
  app.add_option_function<std::string>(
         "--reactive", channel(input.reactive),
         "Channel that is 1 where history lies, or none (default: reactive.mask)")
      .type_name("CHANNEL");
  app.add_option("--jitter", options.jitter,
                 "attribute, none, quincunx, quincunx-half, halton or a file of FRAME X Y (default: the "
                 "attribute, if any)")
      .type_name("NAME|FILE");
}

constexpr const char* kExamples = R"(Examples:
  quincunx-resolve "seq/frame.%04d.exr" --out "up/up.%04d.exr"               the exchange format says the rest
  quincunx-resolve "shot/shot.####.exr" --out "up/up.####.exr" --output 3840x2160 --colour ViewLayer.Combined \
      --velocity ViewLayer.Vector.X,ViewLayer.Vector.Y --velocity-convention blender --depth ViewLayer.Depth.Z
  quincunx-resolve "seq/frame.%04d.exr" --out "up/up.%04d.exr" --output 640x360 --velocity motion.X,motion.Y \
      --velocity-convention fsr2 --truth "truth/truth.%04d.exr"              with scores of each frame
  quincunx-resolve "seq/frame.%04d.exr" --out "up/up.%04d.exr" --frames 101-200   one chunk of a render farm
  quincunx-resolve "seq/frame.%04d.exr" --out "up/up.%04d.exr" -n            only say what would be done
  quincunx-resolve recorded --out "up/up.%04d.exr"                           as it was recorded, bit for bit
Exit status: 0 done, 1 failed, 2 wrong usage, 3 --diagnose found something wrong.)";

UsageError wrong(const std::string& option, const std::string& reason) {
  return UsageError{option, reason};
}

void add_picture_options(CommandLine& app, ResolveOptions& options) {
  static const std::map<std::string, ChannelType> kTypes = {{"half", ChannelType::kHalf},
                                                            {"float", ChannelType::kFloat}};
  app.add_option("INPUT", options.input,
                 "Frames to read: #, @ or %04d is the number; or the folder of a recording")
      .type_name("PATTERN");
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
  app.add_option("--exposure", options.exposure,
                 "Multiplies linear colour in a PNG (default: 1, or as recorded)")
      .positive();
  add_choice(app, "--store", options.stored, kTypes,
             "half or float in an EXR (default: half, or as recorded)");
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
  app.add_option_function<std::string>(
         "--cuts",
         [&options](const std::string& text) {
           auto cuts = parse_frame_numbers(text);
           if (!cuts.ok()) throw wrong("--cuts", cuts.status().message());
           options.sequence.cuts = std::move(cuts).value();
         },
         "Frames that begin another shot, beside those with an attribute reset, for example 25,80")
      .type_name("RANGES");
  app.add_option_function<int>(
         "--warm-up", [&options](int count) { options.warm_up = count; },
         "Frames to read before the first, for its history, and at most after the last (default: as many as "
         "the "
         "method looks back)")
      .in_range(0, 100000)
      .type_name("N");
  app.add_option_function<int>(
         "--two-way", [&options](int count) { options.sequence.two_way = count; },
         "temporal: each frame knows so many later ones, too; 0: none (default: 8 where --velocity-next or "
         "the "
         "camera tells motion to the next frame, else 0)")
      .in_range(0, 64)
      .type_name("K");
  app.add_option_function<std::string>(
         "--memory", [&options](const std::string& text) { options.memory = parse_bytes("--memory", text); },
         "Of histories that --two-way keeps; those beyond go into temporary files in TMPDIR or /var/tmp, "
         "for the same pixels (default: 4GB)")
      .type_name("SIZE");
  app.add_option_function<std::string>(
         "--noise",
         [&options](const std::string& text) {
           options.noise_by_frames = text == "auto";
           const float samples = options.noise_by_frames ? 1 : parse_float("--noise", text);
           if (!(samples >= 1)) throw UsageError{"--noise", fmt::format("'{}' is less than 1", text)};
           options.resolve.temporal.noise = options.noise_by_frames ? 0 : 1 / samples;
         },
         "temporal: a path tracer took so many samples a pixel, and the picture is denoised; auto: as Cycles "
         "says in the first frame, if at most 64, else as frames show (default: it is not)")
      .type_name("SPP|auto");
  app.add_flag("--resume", options.resume, "Leave frames out that are there already");
  app.add_flag("--skip-bad-frames", options.skip_bad_frames, "Go on without frames that cannot be used");
  app.add_flag("-n,--dry-run", options.dry_run, "Only list what would be read and made, and what is missing");
  app.add_flag(
      "--diagnose", options.diagnose,
      "Only say what is wrong with motion, jitter, depth and camera, by up to 16 of the frames themselves");
  app.add_flag("--explain", options.explain, "Only print the plan: passes, buffers, what is left out");
  app.add_option("--threads", options.threads,
                 "Threads that read and write files (default: as many as there are processors)")
      .in_range(1, 256);
  app.add_option("--device", options.device,
                 "OpenCL device: cpu, gpu, an index of --list-devices or part of a name");
  app.add_flag("--list-devices", options.list_devices, "List the OpenCL devices");
  app.add_option(
         "--report", options.report,
         "Write BASE.html, .txt and .json: scores, times, passes; or what --diagnose finds, and where")
      .type_name("BASE");
  app.add_flag("--json", options.json, "Print the report as JSON on standard output");
  app.add_flag("-q,--quiet", options.quiet, "Say nothing but errors");
  app.add_flag("-v,--verbose", options.verbosity, "Say more; twice: everything");
}

// Checks what options alone cannot express.
void check_needs(const ResolveOptions& options) {
  if (options.list_devices) return;
  if (options.input.empty()) throw wrong("INPUT", "is missing: give the pattern of the frames to read");
  const bool writes_nothing =
      options.dry_run || options.explain || options.diagnose || !options.truth.empty();
  if (options.out.empty() && !writes_nothing)
    throw wrong("--out", "is missing: give the pattern of the frames to write");
  if (options.resume && options.out.empty()) throw wrong("--resume", "needs --out");
}

// Refuses options of frames that nobody explains.
void check_recorded(const CommandLine& app, const ResolveOptions& options) {
  const std::string& folder = options.input;
  if (options.noise_by_frames)
    throw wrong("--noise", fmt::format("auto reads EXR frames, and '{}' is a recording", folder));
  for (const char* option :
       {"--output", "--colour", "--velocity", "--velocity-convention", "--velocity-scale", "--depth",
        "--depth-kind", "--near", "--reactive", "--jitter", "--cuts", "--warm-up", "--two-way",
        "--velocity-next", "--velocity-jittered"}) {
    if (app.has(option))
      throw wrong(option, fmt::format("is what the recording in '{}' says itself", folder));
  }
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
    if (options.recorded) check_recorded(app, options);
    check_needs(options);
  });
}

}  // namespace quincunx::tools
