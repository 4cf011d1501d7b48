// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "catalog/scene_catalog.h"
#include "tools/program/command_line.h"

namespace quincunx::bench {

std::vector<BenchMethod> all_methods() {
  const MethodVariant usual = variant_of(ResolveSettings{});
  std::vector<BenchMethod> methods;
  for (const VariantInfo& info : all_variants()) {
    BenchMethod method{.name = info.name, .summary = info.summary, .resolve = {}};
    apply(info.variant, method.resolve);
    method.jitter = scenes::jitter_for(info.variant.method);
    method.detail = scenes::texture_detail_for(info.variant.method, method.jitter);
    method.accumulates = info.variant.method == Method::kTemporal;
    method.is_default = info.variant == usual;
    methods.push_back(std::move(method));
  }
  return methods;
}

namespace {

constexpr double kSmallestScale = 0.02;
constexpr double kLargestScale = 2;
constexpr int kSmallestSide = 16;  // the worst window has 16 x 16 pixels

// A method's twin, which has a mark before its name: what differs.
struct Twin {
  std::string_view mark;
  const char* words;  // added to the summary
  Status (*apply)(BenchMethod&, int noise);
};

constexpr Twin kTwins[] = {
    {"checkerboard/", ", of a checkerboard",
     [](BenchMethod& method, int) {
       method.resolve.targets.shading = Shading::kCheckerboard;
       return Status();
     }},
    {"focus/", ", with a focus",
     [](BenchMethod& method, int) {
       method.focuses = true;
       return Status();
     }},
    {"denoised/", ", denoised",
     [](BenchMethod& method, int noise) {
       if (!method.accumulates || noise == 0) {
         return Status::invalid(
             fmt::format("--methods: '{}' needs --noise, and a method that accumulates", method.name));
       }
       method.resolve.temporal.noise = 1 / static_cast<float>(noise);
       return Status();
     }},
    {"two-way/", ", both ways",
     [](BenchMethod& method, int) {
       if (!method.accumulates)
         return Status::invalid(fmt::format("--methods: '{}' has no history to merge", method.name));
       method.two_way = true;
       return Status();
     }},
};
constexpr std::string_view kEncoded = "@rgba8";
constexpr std::string_view kDual = "dual";

const Twin* twin_of(std::string_view name) {
  const auto* const twin =
      std::ranges::find_if(kTwins, [name](const Twin& one) { return name.starts_with(one.mark); });
  return twin != std::end(kTwins) ? twin : nullptr;
}

Result<BenchMethod> method_named(const std::string& name, int noise);

// The method behind the mark of a twin. Only frames both ways may also be denoised.
Result<BenchMethod> marked_method(const Twin& twin, const std::string& name, int noise) {
  auto method = method_named(name.substr(twin.mark.size()), noise);
  if (!method.ok()) return method;
  method->name.insert(0, twin.mark);
  method->summary += twin.words;
  method->is_default = false;
  if (Status status = twin.apply(method.value(), noise); !status.ok()) return status;
  return method;
}

// "dual0.8/NAME": the method at an output of .8 of the picture on each axis, which is then scaled to it.
Result<BenchMethod> dual_method(const std::string& name, int noise) {
  const std::size_t slash = name.find('/');
  const std::string scale = name.substr(kDual.size(), slash - kDual.size());
  if (auto outputs = scenes::OutputPath::parse(scale, {1000, 1000}, 0); !outputs.ok())
    return Status::invalid(fmt::format("--methods: '{}': {}", name, outputs.status().message()));
  auto method = method_named(name.substr(slash + 1), noise);
  if (!method.ok()) return method;
  if (method->two_way)
    return Status::invalid(fmt::format("--methods: '{}': both ways there is one output", name));
  method->name.insert(0, name.substr(0, slash + 1));
  method->summary += fmt::format(", at {} of the output, scaled", scale);
  method->dual = scale;
  method->is_default = false;
  return method;
}

Result<BenchMethod> method_named(const std::string& name, int noise) {
  if (name.starts_with(kDual) && name.find('/') != std::string::npos) return dual_method(name, noise);
  if (const Twin* const twin = twin_of(name)) {
    const Twin* const inner = twin_of(std::string_view(name).substr(twin->mark.size()));
    if (inner == nullptr || (twin->mark == "two-way/" && inner->mark == "denoised/"))
      return marked_method(*twin, name, noise);
  }
  const bool encoded = name.ends_with(kEncoded);
  const std::string plain = encoded ? name.substr(0, name.size() - kEncoded.size()) : name;
  const auto variant = parse_variant(plain);
  const std::vector<BenchMethod> methods = all_methods();
  const auto found =
      std::ranges::find(methods, variant.ok() ? name_of(variant.value()) : "", &BenchMethod::name);
  if (found == methods.end()) {
    std::vector<std::string> known;
    std::ranges::transform(methods, std::back_inserter(known), &BenchMethod::name);
    const std::string meant = tools::did_you_mean(plain, known);
    return Status::invalid(fmt::format("--methods: there is no method '{}'{}", name,
                                       meant.empty() ? "; --list-methods has all" : meant));
  }
  BenchMethod method = *found;
  if (encoded) {
    // The curve is that of the metrics, which can be taken back to compare with truth.
    method.name += kEncoded;
    method.summary += ", of RGBA8 colour";
    method.resolve.colour = PixelFormat::kRGBA8;
    method.resolve.output.tone_map = ToneMap::kReinhard;
    method.is_default = false;
  }
  return method;
}

Result<std::vector<BenchMethod>> chosen_methods(const std::vector<std::string>& names, int noise) {
  if (names.empty()) return all_methods();
  std::vector<BenchMethod> chosen;
  for (const std::string& name : names) {
    auto method = method_named(name, noise);
    if (!method.ok()) return method.status();
    chosen.push_back(std::move(method).value());
  }
  return chosen;
}

bool is_file(const std::string& name) {
  return name.ends_with(".gltf") || name.ends_with(".glb");
}

Result<std::vector<std::string>> chosen_scenes(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const scenes::SceneEntry& entry : scenes::list_scenes())
    known.push_back(entry.name);
  if (names.empty()) return known;
  for (const std::string& name : names) {
    if (is_file(name) || std::find(known.begin(), known.end(), name) != known.end()) continue;
    return Status::invalid(fmt::format(
        "--scenes: there is no scene '{}'; the built-in ones are {}; a file must end in .gltf or .glb{}",
        name, fmt::join(known, ", "), tools::did_you_mean(name, known)));
  }
  return names;
}

template <typename T>
Status check_once(const char* option, const std::vector<T>& values) {
  for (const T& value : values) {
    if (std::count(values.begin(), values.end(), value) > 1) {
      return Status::invalid(fmt::format("{}: '{}' is there twice", option, value));
    }
  }
  return {};
}

Status check_numbers(const BenchOptions& options) {
  for (const double scale : options.scales) {
    if (scale >= kSmallestScale && scale <= kLargestScale) continue;
    return Status::invalid(fmt::format("--scales: {} is no scale; it must lie between {} and {}", scale,
                                       kSmallestScale, kLargestScale));
  }
  if (options.output.width < kSmallestSide || options.output.height < kSmallestSide) {
    return Status::invalid(fmt::format("--output {}x{} is too small to measure; it must be at least {}x{}",
                                       options.output.width, options.output.height, kSmallestSide,
                                       kSmallestSide));
  }
  return {};
}

Status check_focus(const BenchOptions& options, const std::vector<BenchMethod>& methods) {
  const auto focused =
      std::find_if(methods.begin(), methods.end(), [](const BenchMethod& method) { return method.focuses; });
  if (options.focus.empty()) {
    if (focused == methods.end()) return {};
    return Status::invalid(fmt::format("--methods: '{}' needs --focus OBJECT or X,Y,W,H", focused->name));
  }
  if (options.focus == scenes::kFocusPointer)
    return Status::invalid("--focus pointer is for a window; give an object or a rectangle");
  return scenes::FocusTarget::parse(options.focus, options.output).status();
}

// Noise is of light, and of the whole picture.
Status check_noise(const BenchOptions& options, const std::vector<BenchMethod>& methods) {
  for (const BenchMethod& method : methods) {
    if (options.noise == 0 || (method.resolve.colour != PixelFormat::kRGBA8 && !method.focuses)) continue;
    return Status::invalid(
        fmt::format("--noise: '{}' has frames of 8 bits or a focus, which are without it", method.name));
  }
  return {};
}

// The default method where it is measured, else the last.
std::size_t frame_method_of(const std::vector<BenchMethod>& methods) {
  const auto found = std::find_if(methods.begin(), methods.end(),
                                  [](const BenchMethod& method) { return method.is_default; });
  return found != methods.end() ? static_cast<std::size_t>(found - methods.begin()) : methods.size() - 1;
}

}  // namespace

Result<BenchPlan> plan_from(const BenchOptions& options) {
  if (Status status = check_numbers(options); !status.ok()) return status;
  auto methods = chosen_methods(options.methods, options.noise);
  if (!methods.ok()) return methods.status();
  if (Status status = check_focus(options, methods.value()); !status.ok()) return status;
  if (Status status = check_noise(options, methods.value()); !status.ok()) return status;
  std::vector<std::string> method_names;
  for (const BenchMethod& method : methods.value())
    method_names.push_back(method.name);
  for (const Status& status : {check_once("--methods", method_names), check_once("--scenes", options.scenes),
                               check_once("--scales", options.scales)}) {
    if (!status.ok()) return status;
  }
  auto names = chosen_scenes(options.scenes);
  if (!names.ok()) return names.status();
  BenchPlan plan;
  plan.methods = std::move(methods).value();
  plan.frame_method = frame_method_of(plan.methods);
  plan.scenes = std::move(names).value();
  plan.scales = options.scales;
  std::sort(plan.scales.begin(), plan.scales.end());
  plan.conditions = {.output = options.output,
                     .frames = static_cast<int>(options.frames),
                     .warm_up = options.warm_up,
                     .history_warm_up = std::max(options.history_warm_up, options.warm_up),
                     .rounds = options.rounds,
                     .truth_samples = options.truth,
                     .seed = options.seed,
                     .fps = options.fps,
                     .start = options.start};
  if (options.noise > 0) plan.conditions.noise = options.noise;
  if (!options.focus.empty()) {
    plan.conditions.focus = options.focus;
    plan.conditions.focus_scale = options.focus_scale;
  }
  return plan;
}

Result<BenchPlan> single_plan_from(BenchOptions options) {
  if (options.methods.empty()) options.methods = {name_of(variant_of(ResolveSettings{}))};
  if (options.scenes.empty()) options.scenes = {"courtyard"};
  options.scenes.resize(1);
  options.methods.resize(1);
  return plan_from(options);
}

scenes::SequenceSettings sequence_for(const BenchPlan& plan, double scale, const BenchMethod& method) {
  const Conditions& conditions = plan.conditions;
  scenes::SequenceSettings sequence;
  sequence.output = conditions.output;
  const auto axis = static_cast<float>(scale);
  sequence.scale_path = scenes::ScalePath::fixed({axis, axis}).value();  // plan_from() has checked it
  sequence.jitter = method.jitter;
  sequence.shading = method.resolve.targets.shading;
  if (!method.dual.empty())  // chosen_methods() has checked it
    sequence.outputs = scenes::OutputPath::parse(method.dual, conditions.output, conditions.seed).value();
  sequence.frames = frames_of(conditions) - first_frame_for(conditions, method);
  sequence.fps = conditions.fps;
  sequence.start_seconds = seconds_of(conditions, first_frame_for(conditions, method));
  sequence.detail = method.detail;
  return sequence;
}

scenes::FocusOptions focus_for(const Conditions& conditions, const BenchMethod& method) {
  if (!method.focuses) return {};
  return {.target = scenes::FocusTarget::parse(*conditions.focus, conditions.output).value(),
          .scale = static_cast<float>(*conditions.focus_scale)};
}

int first_frame_for(const Conditions& conditions, const BenchMethod& method) {
  return method.accumulates ? conditions.warm_up - conditions.history_warm_up.value_or(conditions.warm_up)
                            : 0;
}

int frames_of(const Conditions& conditions) {
  return 2 * conditions.warm_up + (1 + conditions.rounds) * conditions.frames;
}

double seconds_of(const Conditions& conditions, int frame) {
  return conditions.start + frame / conditions.fps;
}

// Half a frame after the cut, so that rounding cannot put the first frame before it.
Conditions conditions_for(const Conditions& conditions, const scenes::Scene& scene) {
  Conditions of_scene = conditions;
  if (const auto cut = scenes::next_cut(scene, seconds_of(conditions, conditions.warm_up)))
    of_scene.start = *cut + (0.5 - conditions.warm_up) / conditions.fps;
  return of_scene;
}

}  // namespace quincunx::bench
