// SPDX-License-Identifier: MIT
// The command line of quincunx-resolve.
#include <fmt/format.h>

#include <algorithm>
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

constexpr const char* kExamples = R"(Examples:
  quincunx-resolve "seq/frame.%04d.exr" --out "up/up.%04d.exr"     the exchange format says the rest
  quincunx-resolve "shot/shot.####.exr" --out "up/up.####.exr" --output 3840x2160 \
      --colour ViewLayer.Combined --depth ViewLayer.Depth.Z \
      --velocity ViewLayer.Vector.X,ViewLayer.Vector.Y --velocity-convention blender
  quincunx-resolve "seq/frame.%04d.exr" --out "up/up.%04d.exr" --output 640x360 \
      --velocity motion.X,motion.Y --velocity-convention fsr2 --truth "truth/truth.%04d.exr"
  quincunx-resolve "seq/frame.%04d.exr" --out "up/up.%04d.exr" --frames 101-200   a chunk of a farm
  quincunx-resolve "seq/frame.%04d.exr" --out "up/up.%04d.exr" -n  only say what would be done
  quincunx-resolve recorded --out "up/up.%04d.exr"                 as it was recorded, bit for bit
Exit status: 0 done, 1 failed, 2 wrong usage, 3 --diagnose found something wrong.)";

// "A,B" into two words that are not empty; `example` ends the sentence where it is not that. The words may have commas
// themselves, as many each: names of one layer.
template <typename Take>
Setting pair(const std::string& value, const std::string& example, Take take) {
  return text(value, [example, take](const std::string& words) -> std::string {
    std::size_t comma = words.find(',');
    const auto commas = std::count(words.begin(), words.end(), ',');
    for (auto i = commas / 2; i > 0; --i)
      comma = words.find(',', comma + 1);
    if (commas % 2 == 0 || comma == 0 || comma + 1 == words.size())
      return fmt::format("'{}' is not two with a comma between; {}", words, example);
    return take(words.substr(0, comma), words.substr(comma + 1));
  });
}

// A channel's name, or none.
Setting channel(std::optional<std::string>& target) {
  return text("CHANNEL", [&target](const std::string& name) {
    target = name == "none" ? "" : name;
    return std::string(name.empty() ? "the name is empty; write none for no channel" : "");
  });
}

template <typename Target>
Setting frame_numbers(Target& target) {
  return text("RANGES", [&target](const std::string& words) {
    auto frames = parse_frame_numbers(words);
    if (frames.ok()) target = std::move(frames).value();
    return frames.ok() ? std::string() : frames.error();
  });
}

// "2.5GB".
std::string read_bytes(const std::string& text, std::uint64_t& bytes) {
  const double unit = text.ends_with("GB") ? 1e9 : text.ends_with("MB") ? 1e6 : 0;
  const double count = unit > 0 ? number_in(text.substr(0, text.size() - 2)).value_or(NAN) : NAN;
  if (!(count >= 0 && count * unit < 1e18))
    return fmt::format("'{}' is no size; write for example 2GB or 500MB", text);
  bytes = static_cast<std::uint64_t>(count * unit);
  return {};
}

std::string read_noise(const std::string& text, ResolveOptions& options) {
  float samples = 1;
  options.noise_by_frames = text == "auto";
  if (!options.noise_by_frames) {
    const std::string wrong = number(samples, {.least = 1, .most = 1e9}).take(text);
    if (!wrong.empty()) return wrong + ", nor auto";
  }
  options.resolve.temporal.noise = options.noise_by_frames ? 0 : 1 / samples;
  return {};
}

std::string set_velocity(SequenceInput& input, const std::string& text) {
  if (text == "none" || text == "camera") {
    input.motion = text == "none" ? MotionSource::kNone : MotionSource::kCamera;
    return {};
  }
  input.motion = MotionSource::kChannels;
  return pair("U,V", "write U,V, or none, or camera",
              [&input](const std::string& u, const std::string& v) {
                input.velocity = {u, v};
                return std::string();
              })
      .take(text);
}

std::string set_numbers(Vec2& numbers, const std::string& x, const std::string& y) {
  const Bounds bounds = {.least = -1e9, .most = 1e9};
  const std::string wrong = number(numbers.x, bounds).take(x);
  return wrong.empty() ? number(numbers.y, bounds).take(y) : wrong;
}

// "X,Y", or one number for both.
std::string set_velocity_offset(SequenceInput& input, const std::string& text) {
  const std::size_t comma = std::min(text.find(','), text.size());
  const std::string words[] = {text.substr(0, comma), text.substr(comma < text.size() ? comma + 1 : 0)};
  return set_numbers(input.velocity_offset, words[0], words[1]);
}

std::string set_depth_range(SequenceInput& input, const std::string& zero, const std::string& one) {
  if (const std::string wrong = set_numbers(input.depth_range, zero, one); !wrong.empty()) return wrong;
  return input.depth_range.x == input.depth_range.y
             ? "one distance for all leaves no depth; write --depth none"
             : "";
}

std::string set_velocity_scale(SequenceInput& input, const std::string& x, const std::string& y) {
  VelocityUnits units{VelocityConvention::kScale, {}};
  if (const std::string wrong = set_numbers(units.scale, x, y); !wrong.empty()) return wrong;
  if (units.scale.x == 0 || units.scale.y == 0)
    return "a scale of 0 leaves no motion; write --velocity none for that";
  input.units = units;
  return {};
}

void add_frame_options(CommandLine& line, ResolveOptions& options) {
  line.group("Frames");
  line.add("INPUT", text(options.input, "PATTERN"),
           "Frames to read: #, @ or %04d in the name is the number; or the folder of a recording")
      .common();
  line.add("--frames", frame_numbers(options.frames),
           "Frames to write, for example 1-10x2,20 (default: all there are)")
      .common();
  line.add("--cuts", frame_numbers(options.sequence.cuts),
           "Frames that begin another shot, beside those with an attribute reset: 25,80");
  line.add("--warm-up", number(options.warm_up, {.least = 0, .most = 100000}),
           "Frames to read before the first, for its history, and at most after the last (default: as many "
           "as the method looks back)");
  line.add("--skip-bad-frames", flag(options.skip_bad_frames), "Go on without frames that cannot be used");
  line.add("-n,--dry-run", flag(options.dry_run),
           "Only list what would be read and made, and what is missing")
      .common()
      .tells()
      .excludes({"--explain", "--diagnose"});
  line.add("--diagnose", flag(options.diagnose),
           "Only check motion, jitter, depth and camera, by up to 16 frames")
      .common()
      .excludes({"--explain"});
}

void add_channel_options(CommandLine& line, ResolveOptions& options) {
  SequenceInput& input = options.sequence;
  static const std::map<std::string, VelocityConvention> kConventions = {
      {"nuke", VelocityConvention::kNuke},
      {"blender", VelocityConvention::kBlender},
      {"fsr2", VelocityConvention::kFsr2},
      {"ndc", VelocityConvention::kNdc}};
  static const std::map<std::string, DepthKind> kDepthKinds = {
      {"linear", DepthKind::kLinear},
      {"device", DepthKind::kDevice},
      {"device-reversed", DepthKind::kDeviceReversed}};
  const auto has_depth = [&input] { return input.depth != ""; };
  const auto has_motion = [&input] {
    return input.motion == MotionSource::kChannels || input.motion == MotionSource::kAutomatic;
  };
  const auto has_channels = [&input, has_motion] { return has_motion() || input.next_velocity.has_value(); };
  constexpr const char* kMotion = "channels of motion, not with --velocity none or camera";
  line.group("Channels");
  line.add("--colour,--color", text(input.picture.layer, "LAYER"),
           "The picture: R, G, B, A of LAYER, PART or PART.LAYER (default: without layer, or what is called "
           "beauty, rgba, Combined or the like)")
      .common();
  line.add("--part", text(input.picture.part, "NAME|N"),
           "Part of the picture in files of several, from 0 on");
  line.add("--view-name", text(input.picture.view, "NAME"),
           "View of stereo files: of the picture, motion and depth (default: the file's first)");
  line.add("--input-colour,--input-color", text(input.colour_space, "NAME"),
           "Colour space of the frames: linear, ACEScg, sRGB, KodakLog or another that OpenImageIO knows "
           "(default: as the files say)");
  line.add("--velocity", text("U,V", [&input](const std::string& text) { return set_velocity(input, text); }),
           "Motion's channels; camera: from depth and worldToNDC; none (default: backward.u,backward.v, if "
           "any)")
      .common();
  line.add("--velocity-next",
           pair("U,V", "write U,V",
                [&input](const std::string& u, const std::string& v) {
                  input.next_velocity = {u, v};
                  return std::string();
                }),
           "Channels of the motion to the next frame, for --two-way, in the same sense: earlier - later "
           "where --velocity has previous - current (default: forward.u,forward.v, if any)");
  line.add("--velocity-convention",
           choice(kConventions,
                  [&input](VelocityConvention convention) {
                    input.units = VelocityUnits{convention, {1, 1}};
                  }),
           "Motion is: blender and nuke (previous - current, pixels, up), fsr2 (the same, down), ndc "
           "(current - previous, "
           "-1 to 1, up)")
      .common()
      .counts_if(has_channels, kMotion);
  line.add("--velocity-scale",
           pair("X,Y", "write for example -0.5,0.5",
                [&input](const std::string& x, const std::string& y) {
                  return set_velocity_scale(input, x, y);
                }),
           "Or: factors that make motion current - previous, in parts of the image, y down")
      .excludes({"--velocity-convention"})
      .counts_if(has_channels, kMotion);
  line.add("--velocity-offset",
           text("X,Y", [&input](const std::string& text) { return set_velocity_offset(input, text); }),
           "Values of motion's channels at rest, or one for both: .5 if they were packed into 0 to 1 "
           "(default: 0)")
      .counts_if(has_channels, kMotion);
  line.add("--velocity-jittered", flag(input.velocity_jittered), "The jitter is in the motion")
      .counts_if(has_channels, kMotion);
  line.add("--drawn-velocity", choice(options.resolve.conventions.drawn_velocity),
           "Motion of a pixel: own, that of its surface, or dilated, that of the nearest of its 3x3 "
           "(default: own)")
      .counts_if(has_channels, kMotion);
  line.add("--depth", channel(input.depth), "Depth's channel, or none (default: Z, if any)").common();
  line.add("--depth-kind", choice(input.depth_kind, kDepthKinds),
           "linear (distance along the view axis), device (far is 1) or device-reversed (far is 0)")
      .counts_if(has_depth, "depth, not with --depth none");
  line.add("--depth-range",
           pair("A,B", "write for example 0,-1",
                [&input](const std::string& zero, const std::string& one) {
                  return set_depth_range(input, zero, one);
                }),
           "Depths that the values 0 and 1 stand for: 0,-1 flips the sign, 31,1 undoes white for near "
           "(default: 0,1)")
      .counts_if(has_depth, "depth, not with --depth none");
  line.add("--near", number(input.near_plane, {.least = 1e-9, .most = 1e9}, "D"),
           "Near plane's distance (default: attribute quincunx:near)")
      .counts_if(has_depth, "depth, not with --depth none");
  Setting sense = text("SENSE", [&input](const std::string& name) {
    input.camera = camera_sense_named(name);
    return std::string(input.camera ? "" : "write screen or openexr, with ,flipped or ,transposed behind it");
  });
  for (int bits = 0; bits < 8; ++bits)
    sense.words.push_back(text_of(CameraSense{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0}));
  line.add(
      "--world-to-ndc", sense,
      "Attribute worldToNDC is: screen (-1 to 1, up) or openexr (0 to 1, down), for row vectors; ,flipped: "
      "y the other way; ,transposed (default: detected)");
  line.add("--reactive", channel(input.reactive),
           "Channel that is 1 where history is wrong, as under glass, or none, or a pattern of images "
           "(default: reactive.mask)");
  line.add("--jitter", text(options.jitter, "NAME|FILE"),
           "attribute, none, quincunx, quincunx-half, halton or a file of FRAME X Y (default: the attribute, "
           "if any)")
      .common();
}

void add_picture_options(CommandLine& line, ResolveOptions& options) {
  line.group("Picture");
  line.add("--output", extent(options.sequence.output),
           "Size of the picture (default: attribute quincunx:outputSize)")
      .common();
  line.add(
      "--exposure",
      number(options.exposure, {.least = 0, .most = FrameInputs::kLargestExposure, .beyond = true}, "FACTOR"),
      "Multiplies linear colour before the tone map, and tells temporal how bright the light is "
      "(default: attribute quincunx:exposure, else 1, and temporal measures the light)");
  add_resolve_options(line, options.resolve,
                      {.usual = "by what the frames offer",
                       .settled = [&options] { return options.method_named; },
                       .named = &options.method_named});
  const auto is_temporal = [&options] {
    return !options.method_named || options.resolve.method == Method::kTemporal;
  };
  line.group("Method");
  line.add("--two-way", number(options.sequence.two_way, {.least = 0, .most = 64}, "K"),
           "Use so many later frames for each frame, too; 0: none (default: 8 if --velocity-next or the "
           "camera gives the motion to the next frame, else 0)")
      .counts_if([&options, is_temporal] { return is_temporal() || options.sequence.two_way == 0; },
                 "--method temporal");
  line.add("--memory",
           text("SIZE", [&options](const std::string& text) { return read_bytes(text, options.memory); }),
           "Memory for histories of --two-way; those beyond go into temporary files in TMPDIR or /var/tmp, "
           "for the same pixels (default: 4GB)")
      .counts_if([&options] { return options.sequence.two_way.value_or(1) > 0; }, "--two-way above 0");
  line.add("--noise",
           text("SPP|auto", [&options](const std::string& text) { return read_noise(text, options); }),
           "Denoise frames that a path tracer made with so many samples a pixel; auto: the number that "
           "Cycles wrote in the first frame, if at most 64, else estimated (default: off)")
      .counts_if(is_temporal, "--method temporal");
}

void add_output_options(CommandLine& line, ResolveOptions& options) {
  static const std::map<std::string, ChannelType> kTypes = {{"half", ChannelType::kHalf},
                                                            {"float", ChannelType::kFloat}};
  const auto is_exr = [&options] {
    return format_of(options.out).value_or(FileFormat::kExr) == FileFormat::kExr;
  };
  line.group("Output");
  line.add("--out", text(options.out, "PATTERN"),
           "Frames to write: .exr, .tif, .hdr (linear), .png, .jpg, .dpx (as displayed); #, @ or %04d in the "
           "name "
           "is the number")
      .common()
      .writes();
  line.add("--store", choice(options.stored, kTypes),
           "Number type in EXRs: half (default, or as recorded) or float")
      .counts_if(is_exr, "an --out of .exr");
  line.add("--resume", flag(options.resume), "Skip frames that exist already").needs({"--out"});
  line.add("--truth", text(options.truth, "PATTERN"), "True pictures to score the frames against");
  line.add("--truth-colour,--truth-color", text(options.truth_colour, "LAYER"),
           "Layer of the true pictures, as --colour has it")
      .needs({"--truth"});
  line.add("--report", text(options.report, "BASE"),
           "Write BASE.html, .txt and .json: scores, times, passes; or what --diagnose finds, and where")
      .common()
      .writes();
  line.add("--json", flag(options.json), "Print the report as JSON on standard output");
  line.add("--explain", flag(options.explain), "Only print the plan: passes, buffers, what is left out")
      .tells();
  line.add("--threads", number(options.threads, {.least = 1, .most = 256}),
           "Threads that read and write files (default: as many as there are processors)");
}

void check_together(const CommandLine& line, ResolveOptions& options) {
  if (options.list_devices) return;
  if (options.input.empty())
    throw UsageError{"INPUT", "it is missing: give the pattern of the frames to read"};
  const bool writes_nothing =
      options.dry_run || options.explain || options.diagnose || !options.truth.empty();
  if (options.out.empty() && !writes_nothing)
    throw UsageError{"--out", "it is missing: give the pattern of the frames to write"};
  if (!options.recorded) return;
  // A recording explains its frames itself.
  if (options.noise_by_frames)
    throw UsageError{"--noise", fmt::format("auto reads EXR frames, and '{}' is a recording", options.input)};
  line.refuse({"Channels", "--output", "--cuts", "--warm-up", "--two-way"},
              fmt::format("it is what the recording in '{}' says itself", options.input));
}

}  // namespace

CommandLine command_line(ResolveOptions& options) {
  CommandLine line(
      "Makes full-size frames from an image sequence of any renderer, with OpenCL and without OpenGL.",
      "quincunx-resolve", QUINCUNX_VERSION, kExamples);
  options.threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 256u));
  add_frame_options(line, options);
  add_channel_options(line, options);
  add_picture_options(line, options);
  add_output_options(line, options);
  add_device_options(line, options.device, options.list_devices);
  add_log_options(line, options.quiet, options.verbosity);
  line.check([&options](const CommandLine& given) { check_together(given, options); });
  return line;
}

std::optional<int> parse_command_line(int argc, char** argv, ResolveOptions& options) {
  CommandLine line = command_line(options);
  options.command_line = command_line_text("quincunx-resolve", argc, argv);
  return line.parse(argc, argv);
}

}  // namespace quincunx::tools
