// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
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

// "temporal:balanced" for "temporal"; the name itself where there is no such method.
std::string longest_name(const std::string& name) {
  const auto variant = parse_variant(name);
  return variant.ok() ? name_of(variant.value()) : name;
}

constexpr std::string_view kEncoded = "@rgba8";

// The method on RGBA8 colour. The curve is that of the metrics, which can be taken back to compare with truth.
BenchMethod in_eight_bits(BenchMethod method) {
  method.name += kEncoded;
  method.summary += ", of RGBA8 colour";
  method.resolve.colour = PixelFormat::kRGBA8;
  method.resolve.output.tone_map = ToneMap::kReinhard;
  method.is_default = false;
  return method;
}

// A method's twin of frames in which half of the pixels are shaded.
constexpr std::string_view kCheckerboard = "checkerboard/";

BenchMethod on_checkerboard(BenchMethod method) {
  method.name = std::string(kCheckerboard) + method.name;
  method.summary += ", of a checkerboard";
  method.resolve.targets.shading = Shading::kCheckerboard;
  method.is_default = false;
  return method;
}

// A method's twin with a part of the picture in focus.
constexpr std::string_view kFocus = "focus/";

BenchMethod with_focus(BenchMethod method) {
  method.name = std::string(kFocus) + method.name;
  method.summary += ", with a focus";
  method.focuses = true;
  method.is_default = false;
  return method;
}

// A method's twin at an output of so much of the picture's size on each axis, which is then scaled to it.
constexpr std::string_view kDual = "dual";

// "dual0.8/temporal": 0.8 and "temporal"; nothing for a name without it. Errors: for a scale that is none.
struct DualName {
  std::string scale;
  std::string method;
};
std::optional<DualName> split_dual(const std::string& name) {
  const std::size_t slash = name.find('/');
  if (!name.starts_with(kDual) || slash == std::string::npos) return {};
  return DualName{name.substr(kDual.size(), slash - kDual.size()), name.substr(slash + 1)};
}

BenchMethod at_smaller_output(BenchMethod method, const std::string& scale) {
  method.name = std::string(kDual) + scale + "/" + method.name;
  method.summary += fmt::format(", at {} of the output, scaled", scale);
  method.dual = scale;
  method.is_default = false;
  return method;
}

// The twin of a method that accumulates, which is told how noisy its frames are.
constexpr std::string_view kDenoised = "denoised/";

Result<BenchMethod> denoised(BenchMethod method, int noise) {
  if (!method.accumulates || noise == 0) {
    return Status::invalid(fmt::format("--methods: '{}{}' needs --noise, and a method that accumulates",
                                       kDenoised, method.name));
  }
  method.name = std::string(kDenoised) + method.name;
  method.summary += ", denoised";
  method.resolve.temporal.noise = 1 / static_cast<float>(noise);
  method.is_default = false;
  return method;
}

// The twin of a method that accumulates, with the histories of both directions.
constexpr std::string_view kTwoWay = "two-way/";

Result<BenchMethod> both_ways(BenchMethod method) {
  if (!method.accumulates)
    return Status::invalid(fmt::format("--methods: '{}{}' has no history to merge", kTwoWay, method.name));
  method.name = std::string(kTwoWay) + method.name;
  method.summary += ", both ways";
  method.two_way = true;
  method.is_default = false;
  return method;
}

Result<std::vector<BenchMethod>> chosen_methods(const std::vector<std::string>& names, int noise) {
  std::vector<BenchMethod> methods = all_methods();
  if (names.empty()) return methods;
  std::vector<BenchMethod> chosen;
  for (const std::string& name : names) {
    if (const auto dual = split_dual(name)) {
      if (auto outputs = scenes::OutputPath::parse(dual->scale, {1000, 1000}, 0); !outputs.ok())
        return Status::invalid(fmt::format("--methods: '{}': {}", name, outputs.status().message()));
      auto method = chosen_methods({dual->method}, noise);
      if (!method.ok()) return method.status();
      if (method->front().two_way)
        return Status::invalid(fmt::format("--methods: '{}': both ways there is one output", name));
      chosen.push_back(at_smaller_output(method->front(), dual->scale));
      continue;
    }
    const bool encoded = name.ends_with(kEncoded);
    const bool focuses = name.starts_with(kFocus);
    const bool checkerboard = name.starts_with(kCheckerboard);
    const bool two_way = name.starts_with(kTwoWay);
    std::string plain = encoded ? name.substr(0, name.size() - kEncoded.size()) : name;
    if (two_way) plain.erase(0, kTwoWay.size());
    const bool denoises = plain.starts_with(kDenoised);
    if (denoises) plain.erase(0, kDenoised.size());
    if (checkerboard) plain.erase(0, kCheckerboard.size());
    if (focuses) plain.erase(0, kFocus.size());
    const std::string longest = longest_name(plain);
    const auto found = std::find_if(methods.begin(), methods.end(),
                                    [&](const BenchMethod& method) { return method.name == longest; });
    if (found == methods.end()) {
      std::vector<std::string> known;
      for (const BenchMethod& method : methods)
        known.push_back(method.name);
      const std::string meant = tools::did_you_mean(plain, known);
      return Status::invalid(fmt::format("--methods: there is no method '{}'{}", name,
                                         meant.empty() ? "; --list-methods has all" : meant));
    }
    BenchMethod method = *found;
    if (encoded) method = in_eight_bits(std::move(method));
    if (checkerboard) method = on_checkerboard(std::move(method));
    if (denoises) {
      auto twin = denoised(std::move(method), noise);
      if (!twin.ok()) return twin.status();
      method = std::move(twin).value();
    }
    if (two_way) {
      auto twin = both_ways(std::move(method));
      if (!twin.ok()) return twin.status();
      method = std::move(twin).value();
    }
    chosen.push_back(focuses ? with_focus(std::move(method)) : std::move(method));
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
