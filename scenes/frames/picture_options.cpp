// SPDX-License-Identifier: MIT
#include "frames/picture_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <string>
#include <vector>

#include "catalog/scene_catalog.h"
#include "tools/program/command_line.h"
#include "tools/program/program.h"
#include "tools/program/resolve_settings_options.h"

namespace quincunx::scenes {
namespace {

constexpr const char* kAutomatic = "auto";
constexpr double kDefaultBudget = 0.1;  // share of a frame's time
constexpr double kLongestBudget = 1000;

std::string read_scale(const std::string& text, PartOption& part) {
  part.automatic = text == kAutomatic;
  if (part.automatic) return {};
  const auto scale = tools::number_in(text);
  if (!scale || !(*scale >= kLeastPartScale && *scale <= 1)) {
    return fmt::format("'{}' is no scale of a part; give a number from {} to 1, or auto", text,
                       kLeastPartScale);
  }
  part.scale = static_cast<float>(*scale);
  return {};
}

// Both options of a part. part(): where they go, made by the first of the two that is given.
template <typename Part>
void add_part(tools::CommandLine& line, const std::string& name, const std::string& help, Part part) {
  const std::string scale = "--" + name + "-scale";
  line.add(scale, tools::text("S|auto", [part](const std::string& text) { return read_scale(text, part()); }),
           help + "; auto: a controller holds it");
  line.add("--" + name + "-budget",
           tools::text(
               "MS",
               [part](const std::string& text) {
                 return tools::number(part().budget_ms, {.least = 0.001, .most = kLongestBudget}).take(text);
               }),
           "Milliseconds of a frame that OpenGL may take for it (default: a tenth of a frame of --fps)")
      .needs({scale})
      .counts_if([part] { return part().automatic; }, scale + " auto; nothing holds it else");
}

PartSettings settings_for(const PartOption& part, double fps) {
  if (!part.automatic) return {.scale = part.scale};
  return {.budget_ms = part.budget_ms > 0 ? part.budget_ms : kDefaultBudget * 1000 / fps};
}

Result<ScalePath> scale_path_for(const PictureOptions& options) {
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

std::string read_scene(const std::string& text, std::string& scene) {
  std::vector<std::string> names;
  for (const SceneEntry& entry : list_scenes())
    names.emplace_back(entry.name);
  const bool is_file = text.find('.') != std::string::npos;  // open_scene() says what is wrong with it
  if (!is_file && std::find(names.begin(), names.end(), text) == names.end()) {
    return fmt::format("there is no scene '{}'; --list-scenes has all, and a file ends in .gltf or .glb{}",
                       text, tools::did_you_mean(text, names));
  }
  scene = text;
  return {};
}

}  // namespace

std::string text_of(const PartOption& part) {
  return part.automatic ? kAutomatic : fmt::format("{:g}", part.scale);
}

PartOption part_option(const std::string& text, double budget_ms) {
  if (text == kAutomatic) return {.automatic = true, .budget_ms = budget_ms};
  return {.scale = static_cast<float>(tools::number_in(text).value_or(1))};
}

PartsSettings parts_for(const PartOptions& options, double fps) {
  PartsSettings settings{.shadow = settings_for(options.shadow, fps)};
  if (options.particles) settings.particles = settings_for(*options.particles, fps);
  return settings;
}

void add_picture_options(tools::CommandLine& line, PictureOptions& options,
                         const tools::MethodOptions& about_method) {
  static const std::map<std::string, PixelFormat> kColours = {{"rgba16f", PixelFormat::kRGBA16F},
                                                              {"rgba8", PixelFormat::kRGBA8}};
  line.group("Scene");
  line.add("--scene",
           tools::text("NAME|FILE",
                       [&options](const std::string& text) { return read_scene(text, options.scene); }),
           "Built-in scene, or a .gltf or .glb file (default: the first of --list-scenes)")
      .common();
  line.add("--list-scenes", tools::flag(options.list_scenes), "List the built-in scenes and their purpose")
      .common()
      .tells();
  line.add("--frames", tools::number(options.frames, {.least = 1, .most = 1e15}), "Number of frames")
      .common();
  line.add("--fps", tools::number(options.fps, {.least = 0, .most = 1e6, .beyond = true}),
           "Frames a second of scene time (with --target-fps: that rate)");
  line.add("--start", tools::number(options.start, {.least = -1e6, .most = 1e6}, "SECONDS"),
           "Scene time of the first frame");
  line.add("--seed", tools::number(options.seed),
           "Seed of random parts of scenes and scale paths; same seed, same pixels");
  line.add("--exposure",
           tools::number(options.exposure,
                         {.least = 0, .most = FrameInputs::kLargestExposure, .beyond = true}, "FACTOR"),
           "Multiplies linear colour (default: the scene's)");
  line.group("Picture");
  line.add("--output", tools::extent(options.output), "Size of the picture").common();
  line.add("--scale", tools::text(options.scale, "S|SX,SY"),
           "Render scale of both axes or of each (default: 1)")
      .common();
  line.add("--scale-path", tools::text(options.scale_path, "PATH"),
           "Scale by frame: sweep[:A,B,C], ramp[:A,B], random[:A,B]")
      .excludes({"--scale"});
  line.add("--dual", tools::text(options.dual, "auto|S|random"),
           "The output's resolution is dynamic, too: it follows the viewport's (auto), is fixed, or random");
  line.add("--targets", tools::choice(options.resolve.targets.placement),
           "viewport (default): a part of large targets; placed: targets of just that size");
  line.add("--colour", tools::choice(options.resolve.colour, kColours),
           "Colour target: rgba16f (default; linear light) or rgba8 (exposed, tone mapped and sRGB encoded "
           "as it is drawn)");
  line.add("--shading", tools::choice(options.resolve.targets.shading),
           "Pixels that a frame shades: full (default) or checkerboard, every other one");
  add_part(line, "shadow", "Used part of the shadow map's side (default: 1)",
           [&options]() -> PartOption& { return options.parts.shadow; });
  add_part(line, "particle",
           "Scale of the particles' own viewport, as a part of the frame's (default: none of their own)",
           [&options]() -> PartOption& {
             if (!options.parts.particles) options.parts.particles.emplace();
             return *options.parts.particles;
           });
  line.add("--focus", tools::text(options.focus, "OBJECT|X,Y,W,H"),
           "Draw a part again at --focus-scale and lay it over: an object of the scene, a rectangle of the "
           "picture or, in the window, pointer");
  line.add("--focus-scale", tools::number(options.focus_scale, {.least = 0.02, .most = 2}, "S"),
           "Render scale of that part")
      .needs({"--focus"});
  tools::add_resolve_options(line, options.resolve, about_method);
  line.group("Method");
  line.add("--jitter", tools::choice(options.jitter),
           "none, quincunx, quincunx-half or halton (default: halton for temporal, quincunx for quincunx, "
           "else none)");
  line.check([&options](const tools::CommandLine& given) {
    if (options.resolve.targets.placement == Targets::kPlaced && options.interop == gl::Interop::kGl)
      given.refuse({"--targets"},
                   "placed and --interop gl exclude each other: OpenCL cannot place OpenGL's textures; leave "
                   "one of them out");
    if (options.parts.particles && options.resolve.colour == PixelFormat::kRGBA8)
      given.refuse({"--particle-scale"},
                   "it and --colour rgba8 exclude each other: particles are laid over linear colour; leave "
                   "one of them out");
  });
}

void add_machine_options(tools::CommandLine& line, PictureOptions& options) {
  static const std::map<std::string, gl::Interop> kInterops = {{"auto", gl::Interop::kAuto},
                                                               {"gl", gl::Interop::kGl},
                                                               {"external", gl::Interop::kExternal},
                                                               {"copy", gl::Interop::kCopy}};
  static const std::map<std::string, gl::Platform> kPlatforms = {{"auto", gl::Platform::kAuto},
                                                                 {"surfaceless", gl::Platform::kSurfaceless},
                                                                 {"device", gl::Platform::kDevice}};
  static const std::map<std::string, gl::Api> kApis = {{"4.5", gl::Api::kGl45}, {"es3", gl::Api::kEs3}};
  tools::add_device_options(line, options.device, options.list_devices);
  line.group("Device");
  line.add("--interop", tools::choice(options.interop, kInterops), "How frames pass from OpenGL to OpenCL");
  line.add("--gl", tools::choice(options.api, kApis),
           "API to draw with: 4.5 (default), OpenGL; es3, OpenGL ES 3.1 or later");
  line.add("--egl-platform", tools::choice(options.platform, kPlatforms), "Where OpenGL comes from");
  tools::add_log_options(line, options.quiet, options.verbosity);
}

void print_scenes() {
  for (const SceneEntry& entry : list_scenes()) {
    fmt::print("{:<12} {}\n{:<12} {}\n", entry.name, entry.summary, "", entry.reason);
  }
}

void print_devices(const PictureOptions& options) {
  tools::print_opencl_devices();
  auto context = gl::Context::create(options.platform, options.api);
  if (!context.ok()) {
    fmt::print("OpenGL    {}\n", context.status().message());
    return;
  }
  fmt::print("OpenGL    {} ({})\n", context->info().renderer, context->info().version);
}

Jitter jitter_for(Method method) {
  if (method == Method::kTemporal) return Jitter::kHalton;
  return method == Method::kQuincunx ? Jitter::kQuincunx : Jitter::kNone;
}

// Two frames double the samples a pixel, so textures may be half a level sharper (Binks 2012). All frames together hold
// what the output's own pixels can show: texture_lod_bias().
TextureDetail texture_detail_for(Method method, Jitter jitter) {
  const bool several = method == Method::kQuincunx || method == Method::kTemporal;
  if (!several || jitter == Jitter::kNone) return {};
  if (jitter == Jitter::kHalton) return {.follows_scale = 1};
  return {.lod_bias = -0.5f};
}

Jitter jitter_for(const PictureOptions& options) {
  return options.jitter.value_or(jitter_for(options.resolve.method));
}

Result<FrameSourceSettings> source_settings_for(const PictureOptions& options) {
  auto path = scale_path_for(options);
  if (!path.ok()) return path.status();
  FrameSourceSettings source;
  source.scene = options.scene;
  source.seed = options.seed;
  source.exposure = options.exposure;
  source.device = options.device;
  source.interop = options.interop;
  source.platform = options.platform;
  source.api = options.api;
  source.parts = parts_for(options.parts, options.fps);
  source.focus.scale = options.focus_scale;
  if (!options.focus.empty()) {
    auto target = FocusTarget::parse(options.focus, options.output);
    if (!target.ok()) return target.status();
    source.focus.target = target.value();
    source.focus.endless = options.frames == 0;
  }
  SequenceSettings& settings = source.sequence;
  settings.output = options.output;
  settings.scale_path = path.value();
  if (!options.dual.empty()) {
    auto outputs = OutputPath::parse(options.dual, options.output, options.seed);
    if (!outputs.ok()) return outputs.status();
    settings.outputs = outputs.value();
  }
  settings.jitter = jitter_for(options);
  settings.shading = options.resolve.targets.shading;
  settings.frames = options.frames;
  settings.fps = options.fps;
  settings.start_seconds = options.start;
  settings.detail = texture_detail_for(options.resolve.method, settings.jitter);
  return source;
}

}  // namespace quincunx::scenes
