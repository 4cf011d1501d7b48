// SPDX-License-Identifier: MIT
#include "frames/picture_options.h"

#include <fmt/format.h>

#include <charconv>
#include <map>
#include <string>

#include "catalog/scene_catalog.h"
#include "tools/program/command_line.h"
#include "tools/program/program.h"
#include "tools/program/resolve_settings_options.h"

namespace quincunx::scenes {
namespace {

constexpr const char* kAutomatic = "auto";
constexpr double kDefaultBudget = 0.1;  // share of a frame's time
constexpr double kLongestBudget = 1000;

// The names of both options of a part.
struct PartNames {
  std::string scale;
  std::string budget;
  std::string what;
};

void read_scale(const std::string& option, const std::string& text, PartOption& part) {
  part.automatic = text == kAutomatic;
  if (part.automatic) return;
  const auto scale = tools::number_in(text);
  if (!scale || !(*scale >= kLeastPartScale && *scale <= 1)) {
    throw tools::UsageError{
        option, fmt::format("'{}' is no scale of a part; give a number from {} to 1, or auto", text,
                            kLeastPartScale)};
  }
  part.scale = static_cast<float>(*scale);
}

// part(): where the option is, made by the first of the two that is given.
template <typename Part>
void add_part(tools::CommandLine& app, const PartNames& names, Part part) {
  const auto scale =
      app.add_option_function<std::string>(
             names.scale,
             [part, option = names.scale](const std::string& text) { read_scale(option, text, part()); },
             names.what)
          .type_name("S|auto");
  app.add_option_function<float>(
         names.budget, [part](const float& budget) { part().budget_ms = static_cast<double>(budget); },
         "With auto: milliseconds of OpenGL's work a frame (default: a tenth of a frame of --fps)")
      .in_range(0.001, kLongestBudget)
      .needs(scale)
      .type_name("MS");
  app.when_read([&app, part, names] {
    if (app.has(names.budget) && !part().automatic)
      throw tools::UsageError{names.budget, "nothing holds it; give " + names.scale + " auto"};
  });
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

void add_part_options(tools::CommandLine& app, PartOptions& options) {
  add_part(app,
           {"--shadow-scale", "--shadow-budget",
            "Side of the shadow map's part in use, of the whole (default: 1); auto: held by a controller"},
           [&options]() -> PartOption& { return options.shadow; });
  add_part(app,
           {"--particle-scale", "--particle-budget",
            "Particles in a viewport of their own: its scale, of the frame's (default: drawn with everything "
            "else); auto: held by a controller"},
           [&options]() -> PartOption& {
             if (!options.particles) options.particles.emplace();
             return *options.particles;
           });
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

void add_picture_options(tools::CommandLine& app, PictureOptions& options) {
  static const std::map<std::string, Jitter> kJitters = {{"none", Jitter::kNone},
                                                         {"quincunx", Jitter::kQuincunx},
                                                         {"quincunx-half", Jitter::kQuincunxHalf},
                                                         {"halton", Jitter::kHalton}};

  app.add_option("--scene", options.scene,
                 "Built-in scene, or a .gltf or .glb file (default: the first of the list)");
  app.add_option("--seed", options.seed,
                 "Of what is random in a scene or a scale path; same seed, same pixels")
      .show_default();
  app.add_option_function<std::string>(
         "--output",
         [&options](const std::string& text) {
           const std::string error = tools::parse_extent(text, options.output);
           if (!error.empty()) throw tools::UsageError{"--output", error};
         },
         "Size of the picture (default: 1280x720)")
      .type_name("WxH");
  const auto scale =
      app.add_option("--scale", options.scale, "Render scale of both axes or of each").type_name("S|SX,SY");
  app.add_option("--scale-path", options.scale_path,
                 "Scale by frame: sweep[:A,B,C], ramp[:A,B], random[:A,B]")
      .type_name("PATH")
      .excludes(scale);
  app.add_option(
         "--dual", options.dual,
         "The output's resolution is dynamic, too: auto (follows the viewport's), a fixed scale, or random")
      .type_name("auto|S|random");
  tools::add_resolve_options(app, options.resolve);
  tools::add_choice(app, "--targets", options.resolve.targets.placement, tools::choices<Targets>(),
                    "viewport (default): a part of large targets; placed: targets of just that size");
  tools::add_choice(app, "--jitter", options.jitter, kJitters,
                    "none, quincunx, quincunx-half or halton (default: halton for temporal, quincunx for "
                    "quincunx, else none)");
  static const std::map<std::string, PixelFormat> kColours = {{"rgba16f", PixelFormat::kRGBA16F},
                                                              {"rgba8", PixelFormat::kRGBA8}};
  tools::add_choice(app, "--colour", options.resolve.colour, kColours,
                    "Of the colour target: rgba16f (linear light) or rgba8 (exposed, tone mapped and sRGB "
                    "encoded as it is drawn; default: rgba16f)");
  tools::add_choice(app, "--shading", options.resolve.targets.shading, tools::choices<Shading>(),
                    "Pixels that a frame shades: full or checkerboard, every other one (default: full)");
  add_part_options(app, options.parts);
  app.add_option(
         "--focus", options.focus,
         "Draw a part again at --focus-scale and lay it over: an object of the scene, a rectangle of the "
         "picture or, in the window, pointer")
      .type_name("OBJECT|X,Y,W,H");
  app.add_option("--focus-scale", options.focus_scale, "Render scale of that part")
      .in_range(0.02, 2.0)
      .show_default();
  app.add_option("--exposure", options.exposure, "Multiplies linear colour (default: the scene's)")
      .positive();
  app.add_option("--frames", options.frames, "Number of frames").positive().show_default();
  app.add_option("--fps", options.fps, "Frames a second of scene time (with --target-fps: that rate)")
      .positive()
      .show_default();
  app.add_option("--start", options.start, "Scene time of the first frame, seconds").show_default();
}

void add_machine_options(tools::CommandLine& app, PictureOptions& options) {
  static const std::map<std::string, gl::Interop> kInterops = {
      {"auto", gl::Interop::kAuto}, {"gl", gl::Interop::kGl}, {"copy", gl::Interop::kCopy}};
  static const std::map<std::string, gl::Platform> kPlatforms = {{"auto", gl::Platform::kAuto},
                                                                 {"surfaceless", gl::Platform::kSurfaceless},
                                                                 {"device", gl::Platform::kDevice}};
  app.add_option("--device", options.device,
                 "OpenCL device: cpu, gpu, an index of --list-devices or part of a name");
  tools::add_choice(app, "--interop", options.interop, kInterops,
                    "How frames pass from OpenGL to OpenCL: auto, gl or copy");
  tools::add_choice(app, "--egl-platform", options.platform, kPlatforms, "auto, surfaceless or device");
  static const std::map<std::string, gl::Api> kApis = {{"4.5", gl::Api::kGl45}, {"es3", gl::Api::kEs3}};
  tools::add_choice(app, "--gl", options.api, kApis,
                    "What draws: OpenGL 4.5 or es3, which is OpenGL ES 3.1 or later (default: 4.5)");
  app.add_flag("--list-scenes", options.list_scenes, "List the built-in scenes and why they are there");
  app.add_flag("--list-devices", options.list_devices, "List the OpenCL devices and the OpenGL renderer");
  app.add_flag("-q,--quiet", options.quiet, "Say nothing but errors");
  app.add_flag("-v,--verbose", options.verbosity, "Say more; twice: everything");
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
  if (options.resolve.targets.placement == Targets::kPlaced && options.interop == gl::Interop::kGl) {
    return Status::invalid(
        "--targets placed and --interop gl exclude each other: OpenGL's textures cannot be placed in memory "
        "that OpenCL "
        "reads; leave one of them out");
  }
  if (options.parts.particles && options.resolve.colour == PixelFormat::kRGBA8) {
    return Status::invalid(
        "--particle-scale and --colour rgba8 exclude each other: particles are laid over linear colour; "
        "leave "
        "one of them out");
  }
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
