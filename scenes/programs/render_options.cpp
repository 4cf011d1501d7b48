// SPDX-License-Identifier: MIT
#include "render_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <map>

namespace quincunx::scenes {
namespace {

constexpr const char* kExamples = R"(Examples:
  quincunx-render --out courtyard.png                               one frame of the default scene at 1280x720
  quincunx-render --scale-path sweep --frames 240 --out "out/frame.%04d.png" --report out/report
  quincunx-render --scene model.glb --scale 0.5 --method bilinear --frames 60 --out "orbit.%04d.exr"
  quincunx-render --scene wheel --truth 8 --shutter 0.5 --out truth.exr   supersampled, half a frame's shutter
  quincunx-render --scene chart --scale 0.71 --explain                what this scene needs and what is left out
Exit status: 0 done, 1 failed, 2 wrong usage.)";

// "1280x720" -> Extent
std::string parse_extent(const std::string& text, Extent& extent) {
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, extent.width);
  if (width.ec == std::errc() && width.ptr != end && *width.ptr == 'x') {
    const auto height = std::from_chars(width.ptr + 1, end, extent.height);
    if (height.ec == std::errc() && height.ptr == end && extent.width > 0 && extent.height > 0) return {};
  }
  return fmt::format("'{}' is no size; write WIDTHxHEIGHT, for example 1280x720", text);
}

void add_picture_options(CLI::App& app, RenderOptions& options) {
  static const std::map<std::string, Method> kMethods = {
      {"point", Method::kPoint}, {"bilinear", Method::kBilinear}, {"quincunx", Method::kQuincunx}};
  static const std::map<std::string, Jitter> kJitters = {
      {"none", Jitter::kNone}, {"quincunx", Jitter::kQuincunx}, {"halton", Jitter::kHalton}};
  static const std::map<std::string, ToneMap> kToneMaps = {
      {"clamp", ToneMap::kClamp}, {"reinhard", ToneMap::kReinhard}, {"aces", ToneMap::kAces}};

  app.add_option("--scene", options.scene,
                 "Built-in scene, or a .gltf or .glb file (default: the first of the list)");
  app.add_flag("--list-scenes", options.list_scenes, "List the built-in scenes and why they are there");
  app.add_option("--seed", options.seed,
                 "Of what is random in a scene or a scale path; same seed, same pixels")
      ->capture_default_str();
  app.add_option_function<std::string>(
         "--output",
         [&options](const std::string& text) {
           const std::string error = parse_extent(text, options.output);
           if (!error.empty()) throw CLI::ValidationError("--output", error);
         },
         "Size of the picture (default: 1280x720)")
      ->type_name("WxH");
  auto* scale =
      app.add_option("--scale", options.scale, "Render scale of both axes or of each")->type_name("S|SX,SY");
  app.add_option("--scale-path", options.scale_path,
                 "Scale by frame: sweep[:A,B,C], ramp[:A,B], random[:A,B]")
      ->type_name("PATH")
      ->excludes(scale);
  app.add_option("--method", options.method, "point, bilinear or quincunx (default: quincunx)")
      ->transform(CLI::CheckedTransformer(kMethods, CLI::ignore_case))
      ->type_name("NAME");
  app.add_option("--jitter", options.jitter,
                 "none, quincunx or halton (default: quincunx for that method, else none)")
      ->transform(CLI::CheckedTransformer(kJitters, CLI::ignore_case))
      ->type_name("NAME");
  app.add_option("--tone-map", options.tone_map, "clamp, reinhard or aces (default: aces)")
      ->transform(CLI::CheckedTransformer(kToneMaps, CLI::ignore_case))
      ->type_name("NAME");
  app.add_option("--exposure", options.exposure, "Multiplies linear colour (default: the scene's)")
      ->check(CLI::PositiveNumber);
  app.add_flag("!--no-dither", options.dither, "Round to 8 bits without dither");
  app.add_option("--truth", options.truth,
                 "Supersampled truth instead: N x N samples a pixel at output size, box")
      ->check(CLI::Range(1, 64))
      ->type_name("N");
  app.add_option("--shutter", options.shutter,
                 "With --truth: part of the frame's time that the shutter is open")
      ->check(CLI::Range(0.0, 1.0))
      ->needs("--truth");
}

void add_run_options(CLI::App& app, RenderOptions& options) {
  static const std::map<std::string, gl::Interop> kInterops = {
      {"auto", gl::Interop::kAuto}, {"gl", gl::Interop::kGl}, {"copy", gl::Interop::kCopy}};
  static const std::map<std::string, gl::Platform> kPlatforms = {{"auto", gl::Platform::kAuto},
                                                                 {"surfaceless", gl::Platform::kSurfaceless},
                                                                 {"device", gl::Platform::kDevice}};
  app.add_option("--frames", options.frames, "Number of frames")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--fps", options.fps, "Frames a second of scene time")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--start", options.start, "Scene time of the first frame, seconds")->capture_default_str();
  app.add_option("--out", options.out,
                 "Frames to write: .png (presented) or .exr (linear); #, @ or %04d is the number")
      ->type_name("PATTERN");
  app.add_option("--contact-sheet", options.contact_sheet, "One PNG that shows the whole run")
      ->type_name("FILE");
  app.add_option("--exr-frame", options.exr_frame,
                 "Write this frame's targets and resolved picture as EXR beside --out")
      ->check(CLI::NonNegativeNumber)
      ->type_name("N");
  app.add_option("--report", options.report,
                 "Write BASE.txt and BASE.json: passes, bytes, viewports, devices")
      ->type_name("BASE");
  app.add_option("--device", options.device,
                 "OpenCL device: cpu, gpu, a number of --list-devices or part of a name");
  app.add_flag("--list-devices", options.list_devices, "List the OpenCL devices and the OpenGL renderer");
  app.add_option("--interop", options.interop, "How frames pass from OpenGL to OpenCL: auto, gl or copy")
      ->transform(CLI::CheckedTransformer(kInterops, CLI::ignore_case))
      ->type_name("NAME");
  app.add_option("--egl-platform", options.platform, "auto, surfaceless or device")
      ->transform(CLI::CheckedTransformer(kPlatforms, CLI::ignore_case))
      ->type_name("NAME");
  app.add_flag("!--no-overlap", options.overlap,
               "Finish each frame before the next: slower, cleaner pass times");
  app.add_flag("--explain", options.explain,
               "Print the plan (passes, variants, buffers, bytes, what is left out) and stop");
  app.add_flag("--json", options.json, "Print the report as JSON on standard output");
  app.add_flag("-q,--quiet", options.quiet, "Say nothing but errors");
  app.add_flag("-v,--verbose", options.verbosity, "Say more; twice: everything");
}

std::string joined(int argc, char** argv) {
  std::string line = "quincunx-render";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool plain = !word.empty() && word.find_first_of(" \t'\"%#*?$&;()<>|") == std::string::npos;
    line += plain ? " " + word : " '" + word + "'";
  }
  return line;
}

}  // namespace

std::optional<int> parse_command_line(int argc, char** argv, RenderOptions& options) {
  CLI::App app(
      "Renders a scene at a dynamic resolution with OpenGL and makes the picture from it with OpenCL.",
      "quincunx-render");
  app.footer(kExamples);
  app.set_version_flag("--version", "quincunx-render " QUINCUNX_VERSION);
  app.get_formatter()->column_width(30);
  add_picture_options(app, options);
  add_run_options(app, options);
  options.command_line = joined(argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return std::nullopt;
}

Jitter jitter_for(const RenderOptions& options) {
  if (options.jitter) return *options.jitter;
  return options.method == Method::kQuincunx ? Jitter::kQuincunx : Jitter::kNone;
}

Result<ScalePath> scale_path_for(const RenderOptions& options) {
  if (!options.scale_path.empty()) return ScalePath::parse(options.scale_path, options.seed);
  Vec2 scale;
  const char* end = options.scale.data() + options.scale.size();
  const auto x = std::from_chars(options.scale.data(), end, scale.x);
  scale.y = scale.x;
  bool good = x.ec == std::errc();
  if (good && x.ptr != end) {
    const auto y = std::from_chars(x.ptr + 1, end, scale.y);
    good = *x.ptr == ',' && y.ec == std::errc() && y.ptr == end;
  }
  if (!good) {
    return Status::invalid(
        fmt::format("--scale '{}' is no scale; write S or SX,SY, for example 0.71", options.scale));
  }
  return ScalePath::fixed(scale);
}

Result<FrameSourceSettings> source_settings_for(const RenderOptions& options) {
  auto path = scale_path_for(options);
  if (!path.ok()) return path.status();
  FrameSourceSettings source;
  source.scene = options.scene;
  source.seed = options.seed;
  source.exposure = options.exposure;
  source.device = options.device;
  source.interop = options.interop;
  source.platform = options.platform;
  SequenceSettings& settings = source.sequence;
  settings.output = options.output;
  settings.scale_path = path.value();
  settings.jitter = jitter_for(options);
  settings.frames = options.frames;
  settings.fps = options.fps;
  settings.start_seconds = options.start;
  // Two frames double the samples a pixel, so textures may be half a level sharper (Binks 2012).
  settings.lod_bias =
      options.method == Method::kQuincunx && jitter_for(options) != Jitter::kNone ? -0.5f : 0.0f;
  return source;
}

ResolveSettings resolve_settings_for(const RenderOptions& options) {
  ResolveSettings settings;
  settings.method = options.method;
  settings.tone_map = options.tone_map;
  settings.dither = options.dither;
  return settings;
}

}  // namespace quincunx::scenes
