// SPDX-License-Identifier: MIT
#include "tools/program/resolve_settings_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/program/command_line.h"

namespace quincunx::tools {
namespace {

// Every name that parse_variant() knows.
const std::map<std::string, MethodVariant>& variants_by_name() {
  static const auto by_name = [] {
    std::map<std::string, MethodVariant> all;
    for (const MethodInfo& info : methods())
      all[info.name] = parse_variant(info.name).value();
    for (const VariantInfo& info : all_variants())
      all[info.name] = info.variant;
    return all;
  }();
  return by_name;
}

// All of them in one line: "point, bilinear, ... or temporal[:fast|:balanced|:quality]".
std::string method_list() {
  std::vector<std::string> words;
  for (const MethodInfo& info : methods()) {
    std::string endings;
    for (const VariantInfo& form : all_variants()) {
      if (form.variant.method == info.method && form.name != info.name)
        endings += (endings.empty() ? "" : "|") + form.name.substr(form.name.find(':'));
    }
    words.push_back(endings.empty() ? info.name : fmt::format("{}[{}]", info.name, endings));
  }
  const std::string last = words.back();
  words.pop_back();
  return fmt::format("{} or {}", fmt::join(words, ", "), last);
}

// The field of this recorded name, as each_setting() lists them.
Setting recorded(ResolveSettings& settings, const std::string& name, Bounds bounds = {},
                 const char* value = "N") {
  Setting found;
  each_setting(settings, [&](const char* known, auto& field) {
    using Field = std::remove_reference_t<decltype(field)>;
    if (name != known) return;
    if constexpr (std::is_same_v<Field, bool>) {
      found = flag(field, !field);
    } else if constexpr (std::is_arithmetic_v<Field>) {
      found = number(field, bounds, value);
    } else if constexpr (requires { name_of(field); }) {
      found = choice(field);
    }
  });
  return found;
}

std::string refuse_samples(int& samples, const std::string& text) {
  const double number = number_in(text).value_or(0);
  for (const int power : {4, 8, 16, 32, 64}) {
    if (number != power) continue;
    samples = power;
    return {};
  }
  return fmt::format("'{}' is none of 4, 8, 16, 32, 64", text);
}

bool rings(Method method) {
  return methods()[static_cast<std::size_t>(method)].filter.rings;
}

}  // namespace

void add_resolve_options(CommandLine& line, ResolveSettings& settings, const MethodOptions& about) {
  const auto field = [&settings](const char* name, Bounds bounds = {}, const char* value = "N") {
    return recorded(settings, name, bounds, value);
  };
  const auto where = [&settings, settled = about.settled](bool (*counts)(const ResolveSettings&)) {
    return [&settings, settled, counts] { return !settled() || counts(settings); };
  };
  using Settings = const ResolveSettings&;
  line.group("Method");
  line.add("--method",
           choice(variants_by_name(),
                  [&settings, named = about.named](const MethodVariant& variant) {
                    apply(variant, settings);
                    if (named != nullptr) *named = true;
                  }),
           fmt::format("{} (default: {})", method_list(), about.usual))
      .common();
  line.add("--sharpen", field("sharpness", kPartOfOne, "AMOUNT"),
           "Sharpen the resolved picture: 0 (not) to 1");
  line.add("--blur", field("blur.shutter", {.least = 0, .most = 2}, "SHUTTER"),
           "Motion blur: part of a frame's time that the shutter is open, to 2");
  line.add("--blur-samples",
           text("N",
                [&settings](const std::string& text) { return refuse_samples(settings.blur.samples, text); }),
           "Samples a pixel at most: 4, 8 (default), 16, 32 or 64")
      .needs({"--blur"});
  line.add("--sky-motion", field("conventions.sky_motion"),
           "Motion of the sky where its velocity is 0: as-drawn (default: none), camera or evidence")
      .counts_if(where([](Settings s) { return uses_earlier_frames(s.method) || s.blur.shutter > 0; }),
                 "--method quincunx or temporal, or --blur");
  line.add("--velocity-weight", field("quincunx.velocity_weight", {.least = 0, .most = 1e6}, "K"),
           "quincunx:velocity and :point: how much motion lowers the previous frame's weight")
      .counts_if(where([](Settings s) {
                   return s.method == Method::kQuincunx && s.quincunx.form == TwoFrameForm::kVelocity;
                 }),
                 "--method quincunx or quincunx:point");
  line.add("--residual-weight", field("quincunx.residual_weight", {.least = 0, .most = 1e6}, "K"),
           "quincunx:reprojected: the same for a difference between both frames' motions; 0: none")
      .counts_if(where([](Settings s) {
                   return s.method == Method::kQuincunx && s.quincunx.form == TwoFrameForm::kReprojected;
                 }),
                 "--method quincunx:reprojected");
  line.add("--view", field("temporal.view"), "Show how temporal decides, in place of the picture")
      .counts_if(where([](Settings s) { return s.method == Method::kTemporal; }), "--method temporal");
  line.add("--no-clamp-ringing", field("filter.clamp_ringing"),
           "Let catmull-rom, mitchell and lanczos overshoot at edges")
      .counts_if(where([](Settings s) { return rings(s.method); }),
                 "--method catmull-rom, mitchell or lanczos");
  line.add("--grain", field("filter.grain", kPartOfOne, "A"),
           "Amplitude of noise's grain at scale 0; none at scale 1")
      .counts_if(where([](Settings s) { return s.method == Method::kNoise; }), "--method noise");
  line.add("--still-noise", field("filter.noise_moves"), "The same noise in every frame")
      .counts_if(
          where([](Settings s) { return s.method == Method::kNoise || s.method == Method::kNoiseOffset; }),
          "--method noise or noise-offset");
  line.add("--check-motion", field("checks_motion"), "Check the signs of velocity, and report wrong ones");
  line.group("Picture");
  line.add("--tone-map", field("output.tone_map"), "Tone map of 8-bit pictures");
  line.add("--no-dither", field("output.dither"), "Round to 8 bits without dither");
}

void add_device_options(CommandLine& line, std::string& device, bool& lists) {
  line.group("Device");
  line.add("--device", text(device, "DEVICE"), "cpu, gpu, a number of --list-devices or part of a name");
  line.add("--list-devices", flag(lists), "List the devices for OpenCL and OpenGL").tells();
}

void add_log_options(CommandLine& line, bool& quiet, int& verbosity) {
  line.group("Help");
  line.add("-q,--quiet", flag(quiet), "Print only errors").excludes({"--verbose"});
  line.add("-v,--verbose", count(verbosity), "Print more; twice: everything").repeats();
}

std::string resolve_settings_text(const ResolveSettings& settings) {
  const std::string noise =
      settings.temporal.noise > 0 ? fmt::format(", denoised {}", settings.temporal.noise) : "";
  return fmt::format(
      "{}, view {}, sky motion {}, drawn velocity {}, velocity weight {}, ringing {}, grain {}, noise {}, "
      "sharpness {}, blur {} of {} samples{}",
      name_of(variant_of(settings)), name_of(settings.temporal.view),
      name_of(settings.conventions.sky_motion), name_of(settings.conventions.drawn_velocity),
      settings.quincunx.velocity_weight, settings.filter.clamp_ringing ? "clamped" : "free",
      settings.filter.grain, settings.filter.noise_moves ? "moves" : "still", settings.sharpness,
      settings.blur.shutter, settings.blur.samples, noise);
}

}  // namespace quincunx::tools
