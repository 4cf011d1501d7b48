// SPDX-License-Identifier: MIT
#include "picture_options.h"

#include <fmt/format.h>

#include <charconv>
#include <map>

#include "quincunx/device.h"
#include "scene_catalog.h"
#include "tools/program.h"

namespace quincunx::scenes {
namespace {

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

// An option that takes one of a few names; set() gets the value.
template <typename Value, typename Set>
void add_choice(CLI::App& app, const std::string& option, const std::map<std::string, Value>& names,
                const std::string& description, Set set) {
  const auto choose = [option, set, &names](const std::string& name) {
    const auto found = names.find(CLI::detail::to_lower(name));
    if (found == names.end()) {
      std::string choices;
      for (const auto& [choice, value] : names)
        choices += (choices.empty() ? "" : ", ") + choice;
      throw CLI::ValidationError(option, fmt::format("'{}' is none of {}", name, choices));
    }
    set(found->second);
  };
  app.add_option_function<std::string>(option, choose, description)->type_name("NAME");
}

template <typename Target, typename Value>
void add_choice(CLI::App& app, const std::string& option, Target& target,
                const std::map<std::string, Value>& names, const std::string& description) {
  add_choice(app, option, names, description, [&target](const Value& value) { target = value; });
}

// What a name of --method stands for.
struct MethodChoice {
  Method method;
  TwoFrameForm form = QuincunxSettings{}.form;
};

void add_method_options(CLI::App& app, PictureOptions& options) {
  static const std::map<std::string, MethodChoice> kMethods = {
      {"point", {Method::kPoint}},
      {"bilinear", {Method::kBilinear}},
      {"b-spline", {Method::kBSpline}},
      {"catmull-rom", {Method::kCatmullRom}},
      {"lanczos2", {Method::kLanczos2}},
      {"noise", {Method::kNoise}},
      {"noise-offset", {Method::kNoiseOffset}},
      {"quincunx", {Method::kQuincunx}},
      {"quincunx:mean", {Method::kQuincunx, TwoFrameForm::kMean}},
      {"quincunx:velocity", {Method::kQuincunx, TwoFrameForm::kVelocity}}};
  add_choice(app, "--method", kMethods,
             "point, bilinear, b-spline, catmull-rom, lanczos2, noise, noise-offset or "
             "quincunx[:mean|:velocity] (default: quincunx)",
             [&options](const MethodChoice& choice) {
               options.resolve.method = choice.method;
               options.resolve.quincunx.form = choice.form;
             });
  app.add_option("--velocity-weight", options.resolve.quincunx.velocity_weight,
                 "K of quincunx:velocity: how fast motion takes the previous frame away")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->type_name("K");
  app.add_flag("!--no-clamp-ringing", options.resolve.clamp_ringing,
               "Let catmull-rom and lanczos2 overshoot at edges");
  app.add_option("--grain", options.resolve.grain, "Amplitude of noise's grain at scale 0; none at scale 1")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str()
      ->type_name("A");
  app.add_flag("!--still-noise", options.resolve.noise_moves, "The same noise in every frame");
}

}  // namespace

void add_picture_options(CLI::App& app, PictureOptions& options) {
  static const std::map<std::string, Jitter> kJitters = {{"none", Jitter::kNone},
                                                         {"quincunx", Jitter::kQuincunx},
                                                         {"quincunx-half", Jitter::kQuincunxHalf},
                                                         {"halton", Jitter::kHalton}};
  static const std::map<std::string, ToneMap> kToneMaps = {
      {"clamp", ToneMap::kClamp}, {"reinhard", ToneMap::kReinhard}, {"aces", ToneMap::kAces}};

  app.add_option("--scene", options.scene,
                 "Built-in scene, or a .gltf or .glb file (default: the first of the list)");
  app.add_option("--seed", options.seed,
                 "Of what is random in a scene or a scale path; same seed, same pixels")
      ->capture_default_str();
  app.add_option_function<std::string>(
         "--output",
         [&options](const std::string& text) {
           const std::string error = tools::parse_extent(text, options.output);
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
  add_method_options(app, options);
  add_choice(app, "--jitter", options.jitter, kJitters,
             "none, quincunx, quincunx-half or halton (default: quincunx for that method, else none)");
  add_choice(app, "--tone-map", options.resolve.tone_map, kToneMaps,
             "clamp, reinhard or aces (default: aces)");
  app.add_option("--exposure", options.exposure, "Multiplies linear colour (default: the scene's)")
      ->check(CLI::PositiveNumber);
  app.add_flag("!--no-dither", options.resolve.dither, "Round to 8 bits without dither");
  app.add_option("--frames", options.frames, "Number of frames")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--fps", options.fps, "Frames a second of scene time")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--start", options.start, "Scene time of the first frame, seconds")->capture_default_str();
}

void add_machine_options(CLI::App& app, PictureOptions& options) {
  static const std::map<std::string, gl::Interop> kInterops = {
      {"auto", gl::Interop::kAuto}, {"gl", gl::Interop::kGl}, {"copy", gl::Interop::kCopy}};
  static const std::map<std::string, gl::Platform> kPlatforms = {{"auto", gl::Platform::kAuto},
                                                                 {"surfaceless", gl::Platform::kSurfaceless},
                                                                 {"device", gl::Platform::kDevice}};
  app.add_option("--device", options.device,
                 "OpenCL device: cpu, gpu, a number of --list-devices or part of a name");
  add_choice(app, "--interop", options.interop, kInterops,
             "How frames pass from OpenGL to OpenCL: auto, gl or copy");
  add_choice(app, "--egl-platform", options.platform, kPlatforms, "auto, surfaceless or device");
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
  const std::vector<DeviceInfo> devices = Device::list();
  for (const DeviceInfo& device : devices) {
    fmt::print("OpenCL {}  {} ({}, {})\n          {} units, {:.1f} GiB{}{}\n", device.index, device.name,
               device.platform, device.driver, device.compute_units,
               static_cast<double>(device.global_memory_bytes) / (1 << 30), device.images ? ", images" : "",
               device.gl_sharing ? ", GL sharing advertised" : "");
  }
  if (devices.empty()) fmt::print("OpenCL    no device\n");
  auto context = gl::EglContext::create(options.platform);
  if (!context.ok()) {
    fmt::print("OpenGL    {}\n", context.status().message());
    return;
  }
  fmt::print("OpenGL    {} ({})\n", context->info().renderer, context->info().version);
}

Jitter jitter_for(const PictureOptions& options) {
  if (options.jitter) return *options.jitter;
  return options.resolve.method == Method::kQuincunx ? Jitter::kQuincunx : Jitter::kNone;
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
  SequenceSettings& settings = source.sequence;
  settings.output = options.output;
  settings.scale_path = path.value();
  settings.jitter = jitter_for(options);
  settings.frames = options.frames;
  settings.fps = options.fps;
  settings.start_seconds = options.start;
  // Two frames double the samples a pixel, so textures may be half a level sharper (Binks 2012).
  settings.lod_bias =
      options.resolve.method == Method::kQuincunx && jitter_for(options) != Jitter::kNone ? -0.5f : 0.0f;
  return source;
}

}  // namespace quincunx::scenes
